#pragma once

#include <atomic>
#include <thread>

namespace apsis::c {

/// The thread that runs an observer. Its calls may ask for dense output during an integration; those of other
/// threads may not.
class observing_thread {
 public:
  /// Whether the calling thread runs the observer.
  bool is_this_one() const { return id_.load() == std::this_thread::get_id(); }

  /// Returns call(), during which the calling thread runs the observer. Exceptions end this, too.
  template <class Call>
  int during(const Call& call) {
    return with(std::this_thread::get_id(), call);
  }
  /// Returns call(), during which no thread runs the observer.
  template <class Call>
  int pausing(const Call& call) {
    return with(std::thread::id(), call);
  }

 private:
  template <class Call>
  int with(std::thread::id id, const Call& call) {
    struct until_the_end {
      std::atomic<std::thread::id>& set;
      std::thread::id before;
      ~until_the_end() { set = before; }
    };
    const until_the_end scope{id_, id_.exchange(id)};
    return call();
  }

  std::atomic<std::thread::id> id_{};  ///< that of no thread without an observer
};

}  // namespace apsis::c
