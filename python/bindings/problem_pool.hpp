#pragma once

#include <apsis/exec/processors.hpp>
#include <apsis/semidiscrete/semidiscrete_problem.hpp>

#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace apsis::python {

/// Equal problems, one for each call that is in progress. A problem has scratch memory, so that calls from
/// several threads of Python, or from a function of the user that a problem calls, must not share one. No
/// call waits for another: a lock would end in a deadlock where such a function waits for another thread.
class problem_pool {
 public:
  using maker = std::function<std::unique_ptr<semidiscrete_problem>()>;

  explicit problem_pool(maker make) : make_(std::move(make)) { idle_.reserve(most_idle_); }

  /// Returns a problem that no other call uses; the pool, which must outlive it, gets it back. Needs the GIL,
  /// since ε may be a function of the user.
  std::shared_ptr<semidiscrete_problem> take() {
    std::unique_ptr<semidiscrete_problem> one = idle();
    if (!one) one = make_();
    return {one.release(),
            [this](semidiscrete_problem* used) { give_back(std::unique_ptr<semidiscrete_problem>(used)); }};
  }

 private:
  std::unique_ptr<semidiscrete_problem> idle() {
    const std::lock_guard only(mutex_);
    if (idle_.empty()) return nullptr;
    auto one = std::move(idle_.back());
    idle_.pop_back();
    return one;
  }

  /// More problems than processors are not kept.
  void give_back(std::unique_ptr<semidiscrete_problem> used) {
    const std::lock_guard only(mutex_);
    if (idle_.size() < most_idle_) idle_.push_back(std::move(used));
  }

  maker make_;
  std::mutex mutex_;
  std::size_t most_idle_ = static_cast<std::size_t>(available_processors());
  std::vector<std::unique_ptr<semidiscrete_problem>> idle_;
};

}  // namespace apsis::python
