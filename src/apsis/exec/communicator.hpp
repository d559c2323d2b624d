#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace apsis {

/// Numbers that one process sends to another.
struct message {
  int rank;                   ///< rank of the other process
  std::span<double> numbers;  ///< sent, or to be overwritten; valid until finish_exchange()
};

/// Messages and bytes that a process has sent.
struct communication_count {
  long messages = 0,   ///< messages of exchanges
      bytes = 0,       ///< bytes in these messages
      reductions = 0;  ///< sums, minima and broadcasts
};

/// The processes of a run: one, or several that have a part of the mesh each. Every member that communicates
/// is collective: all processes call it in the same order with data of the same size.
class communicator {
 public:
  virtual ~communicator() = default;

  virtual int rank() const = 0;                   ///< number of this process, 0 … size() − 1
  virtual int size() const = 0;                   ///< number of processes
  bool is_root() const { return rank() == 0; }    ///< whether this process writes messages and files
  bool is_single() const { return size() == 1; }  ///< whether there is one process only

  /// values ← the elementwise sums over all processes, on every process. Sums of integers do not depend on
  /// their order.
  void sum(std::span<std::int64_t> values);
  /// values ← the elementwise minima over all processes, on every process; NaN is not allowed.
  void lowest(std::span<double> values);
  /// values ← those of process `from`.
  void broadcast(std::span<std::byte> values, int from = 0);
  /// Returns the bytes of every process in the order of ranks on the root, and an empty list elsewhere. Sizes
  /// may differ.
  std::vector<std::vector<std::byte>> gather(std::span<const std::byte> values);
  /// Starts to exchange messages: at most one for each ordered pair of processes, of the same length at both
  /// ends.
  void begin_exchange(std::span<const message> sent, std::span<const message> received);
  /// Lets the messages of begin_exchange() advance during other work, because many MPI libraries move long
  /// messages only within their functions. Not collective; only the thread that communicates may call it. A
  /// call every few microseconds is cheap enough.
  void advance_exchange() { do_advance_exchange(); }
  /// Waits for the messages of begin_exchange(), if there are any.
  void finish_exchange();

  /// Returns the number of processes on this machine, which share its processors and memory.
  virtual int processes_here() const { return 1; }
  /// Returns the index of this process on this machine, 0 … processes_here() − 1.
  virtual int number_here() const { return 0; }
  /// Returns the Fortran handle of the MPI communicator, for libraries that communicate themselves; −1 for a
  /// single process.
  virtual std::int64_t handle() const { return -1; }
  /// Returns true once all processes have called this, and false after `seconds`. The barrier sleeps while
  /// it waits.
  virtual bool all_call_within(double seconds) = 0;
  /// The last call of every process. `mine` is the error with which the process ends, or nullptr. Any member
  /// that waits for a failed process throws the error of that process, with its rank in the message. This
  /// member does so only if `mine` is nullptr. Returns true once all processes have called it. Returns false
  /// after `seconds`: another process then neither ends nor communicates. Afterwards only abort() and the
  /// destructor may be called.
  virtual bool end_together(const std::exception_ptr& mine, double seconds) = 0;
  /// Limits how long members wait for other processes once asked() returns true. After further `seconds` they
  /// throw error(exit_code::interrupted); end_together() returns false.
  void limit_waiting(std::function<bool()> asked, double seconds) {
    asked_ = std::move(asked);
    patience_ = seconds;
  }
  /// Ends all processes with an exit code, in case one does not respond. A launcher may hang afterwards.
  [[noreturn]] virtual void abort(int code) const = 0;
  /// Returns the numbers of messages, bytes and reductions of this process since its start.
  const communication_count& count() const { return count_; }

 protected:
  /// Whether the end has been requested; see limit_waiting().
  bool asked_to_end() const { return asked_ && asked_(); }
  double patience() const { return patience_; }  ///< seconds that members wait after such a request

 private:
  virtual void do_sum(std::span<std::int64_t> values) = 0;
  virtual void do_lowest(std::span<double> values) = 0;
  virtual void do_broadcast(std::span<std::byte> values, int from) = 0;
  virtual std::vector<std::vector<std::byte>> do_gather(std::span<const std::byte> values) = 0;
  virtual void do_begin_exchange(std::span<const message> sent, std::span<const message> received) = 0;
  virtual void do_advance_exchange() {}
  virtual void do_finish_exchange() = 0;

  communication_count count_;
  std::function<bool()> asked_;
  double patience_ = 0.0;
};

/// Returns the communicator of a single process.
std::shared_ptr<communicator> single_process();

/// Returns the numbers of all processes as one list in the order of ranks on the root, and an empty list
/// elsewhere. Collective.
std::vector<double> gather_numbers(communicator& processes, std::span<const double> mine);

}  // namespace apsis
