#include <apsis/exec/processes.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/internal/with_mpi/failure_notice.hpp>
#include <apsis/exec/launcher.hpp>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <mpi.h>

namespace apsis {
namespace {

/// MPI counts with int, so that longer data are sent in pieces.
constexpr std::size_t longest_piece = std::size_t{1} << 30U;

template <class T>
int count_of(std::span<T> values) {
  if (values.size() > longest_piece) throw std::length_error("a message of more than 2^30 numbers");
  return static_cast<int>(values.size());
}

/// A duplicate of an MPI communicator. `session` finalizes MPI after the communicator if this program
/// initialized MPI.
class mpi_communicator final : public communicator {
 public:
  explicit mpi_communicator(MPI_Comm of, std::shared_ptr<void> session = nullptr)
      : session_(std::move(session)) {
    check_mpi(MPI_Comm_dup(of, &all_), "MPI_Comm_dup");
    check_mpi(MPI_Comm_dup(of, &ends_), "MPI_Comm_dup");
    MPI_Comm_rank(all_, &rank_);
    MPI_Comm_size(all_, &size_);
    MPI_Comm here = MPI_COMM_NULL;
    check_mpi(MPI_Comm_split_type(all_, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here),
              "MPI_Comm_split_type");
    MPI_Comm_size(here, &here_);
    MPI_Comm_rank(here, &number_here_);
    MPI_Comm_free(&here);
    notice_ = std::make_unique<failure_notice>(ends_);
  }
  ~mpi_communicator() override {
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (finalized != 0) {
      // MPI_Finalize has ended its request.
      static_cast<void>(notice_.release());  // NOLINT(bugprone-unused-return-value)
      return;
    }
    notice_.reset();
    MPI_Comm_free(&all_);
    MPI_Comm_free(&ends_);
  }
  mpi_communicator(const mpi_communicator&) = delete;
  mpi_communicator& operator=(const mpi_communicator&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int processes_here() const override { return here_; }
  int number_here() const override { return number_here_; }
  std::int64_t handle() const override { return MPI_Comm_c2f(all_); }
  bool all_call_within(double seconds) override {
    MPI_Request request = MPI_REQUEST_NULL;
    check_mpi(MPI_Ibarrier(ends_, &request), "MPI_Ibarrier");
    for (const stopwatch waited; waited.seconds() < seconds; pause()) {
      int arrived = 0;
      check_mpi(MPI_Test(&request, &arrived, MPI_STATUS_IGNORE), "MPI_Test");
      if (arrived != 0) return true;
    }
    return false;
  }
  bool end_together(const std::exception_ptr& mine, double seconds) override {
    cancel_received(exchange_);
    MPI_Request all_here = MPI_REQUEST_NULL;
    for (const stopwatch waited; waited.seconds() < seconds; pause()) {
      if (asked_to_end()) seconds = std::min(seconds, waited.seconds() + patience());
      discard_messages();
      if (mine && waited.seconds() > delay_of_notice && !notice_->known()) notice_->announce(mine);
      if (!exchange_.complete()) continue;
      if (all_here == MPI_REQUEST_NULL) check_mpi(MPI_Ibarrier(ends_, &all_here), "MPI_Ibarrier");
      int here = 0;
      check_mpi(MPI_Test(&all_here, &here, MPI_STATUS_IGNORE), "MPI_Test");
      if (here == 0) continue;
      notice_->finish(mine);
      return true;
    }
    return false;
  }
  [[noreturn]] void abort(int code) const override {
    MPI_Abort(all_, code);
    std::_Exit(code);
  }

 private:
  /// Messages of this process that are under way.
  struct pending {
    std::vector<MPI_Request> requests;
    std::size_t received = 0;  ///< how many of the requests, the first ones, receive

    bool complete() {
      int all_done = 0;
      if (!requests.empty())
        check_mpi(
            MPI_Testall(static_cast<int>(requests.size()), requests.data(), &all_done, MPI_STATUSES_IGNORE),
            "MPI_Testall");
      if (all_done != 0) requests.clear();
      return requests.empty();
    }
  };
  struct stopwatch {
    std::chrono::steady_clock::time_point begun = std::chrono::steady_clock::now();
    double seconds() const {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    }
  };
  static void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

  /// Waits for messages. Throws the error of a process that fails meanwhile: a blocking call of MPI would
  /// wait for ever.
  void wait(pending& messages) {
    std::optional<stopwatch> asked;
    for (long turn = 1; !messages.complete(); ++turn) {
      if (turn % turns_of_notice == 0) throw_if_failed(&messages);
      if (turn % turns_of_signals == 0 && asked_to_end()) {
        if (!asked) asked.emplace();
        if (asked->seconds() > patience()) {
          abandon(messages);
          throw error(exit_code::interrupted,
                      fmt::format("interrupted: process {} waited {:.0f} s for another one (which hangs?); "
                                  "continue from the last checkpoint",
                                  rank_, patience()));
        }
      }
      if (turn > turns_of_spinning) std::this_thread::yield();
    }
  }
  void throw_if_failed(pending* messages = nullptr) {
    if (!notice_->arrived()) return;
    if (messages != nullptr) abandon(*messages);
    notice_->raise();
  }
  static void cancel_received(pending& messages) {
    for (std::size_t k = 0; k < std::min(messages.received, messages.requests.size()); ++k)
      if (messages.requests[k] != MPI_REQUEST_NULL) MPI_Cancel(&messages.requests[k]);
  }
  /// Withdraws messages, so that their memory may be freed. Meanwhile discards messages of other processes,
  /// because their senders wait for this process.
  void abandon(pending& messages) {
    cancel_received(messages);
    for (const stopwatch waited; !messages.complete() && waited.seconds() < longest_withdrawal; pause())
      discard_messages();
    messages.requests.clear();
  }
  /// Receives what was sent to this process before a failure, so that the senders need not wait.
  void discard_messages() {
    while (discarded_.complete()) {
      int found = 0, bytes = 0;
      MPI_Status status;
      check_mpi(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, all_, &found, &status), "MPI_Iprobe");
      if (found == 0) return;
      MPI_Get_count(&status, MPI_BYTE, &bytes);
      unread_.resize(static_cast<std::size_t>(std::max(bytes, 0)));
      check_mpi(MPI_Irecv(unread_.data(), bytes, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, all_,
                          &discarded_.requests.emplace_back()),
                "MPI_Irecv");
    }
  }

  void send(const void* data, int bytes, int to, int tag) {
    pending one;
    check_mpi(MPI_Isend(data, bytes, MPI_BYTE, to, tag, all_, &one.requests.emplace_back()), "MPI_Isend");
    wait(one);
  }
  void receive(void* data, int bytes, int from, int tag) {
    pending one{{}, 1};
    check_mpi(MPI_Irecv(data, bytes, MPI_BYTE, from, tag, all_, &one.requests.emplace_back()), "MPI_Irecv");
    wait(one);
  }

  void trade(const void* mine, void* theirs, int bytes, int with) {
    pending both{{}, 1};
    check_mpi(MPI_Irecv(theirs, bytes, MPI_BYTE, with, reductions, all_, &both.requests.emplace_back()),
              "MPI_Irecv");
    check_mpi(MPI_Isend(mine, bytes, MPI_BYTE, with, reductions, all_, &both.requests.emplace_back()),
              "MPI_Isend");
    wait(both);
  }

  /// Combines the values of all processes on every process by recursive doubling: about log₂(size) messages,
  /// one after another. Processes beyond a power of two send their values to a neighbour and receive the
  /// result from it.
  template <class T, class Combine>
  void reduce(std::span<T> values, const Combine& combine) {
    throw_if_failed();
    const int bytes = count_of(std::as_bytes(values));
    std::vector<T> others(values.size());
    const auto take = [&] {
      std::transform(values.begin(), values.end(), others.begin(), values.begin(), combine);
    };
    const int power = static_cast<int>(std::bit_floor(static_cast<unsigned>(size_))), beyond = size_ - power;
    const bool paired = rank_ < 2 * beyond;
    if (paired && rank_ % 2 == 1) {
      send(values.data(), bytes, rank_ - 1, reductions);
      return receive(values.data(), bytes, rank_ - 1, reductions);
    }
    if (paired) {
      receive(others.data(), bytes, rank_ + 1, reductions);
      take();
    }
    const int place = paired ? rank_ / 2 : rank_ - beyond;
    for (int bit = 1; bit < power; bit <<= 1) {
      const int other = place ^ bit;
      trade(values.data(), others.data(), bytes, other < beyond ? 2 * other : other + beyond);
      take();
    }
    if (paired) send(values.data(), bytes, rank_ + 1, reductions);
  }
  /// Sends bytes from one process to all others along a binomial tree.
  void spread(std::span<std::byte> values, int from) {
    const int place = (rank_ - from + size_) % size_;
    int bit = 1;
    while (bit < size_ && (place & bit) == 0) bit <<= 1;
    if (place != 0) receive(values.data(), count_of(values), (rank_ - bit + size_) % size_, broadcasts);
    for (bit >>= 1; bit > 0; bit >>= 1)
      if (place + bit < size_) send(values.data(), count_of(values), (rank_ + bit) % size_, broadcasts);
  }

  void do_sum(std::span<std::int64_t> values) override {
    reduce(values, [](std::int64_t a, std::int64_t b) { return a + b; });
  }
  void do_lowest(std::span<double> values) override {
    reduce(values, [](double a, double b) { return std::min(a, b); });
  }
  void do_broadcast(std::span<std::byte> values, int from) override {
    throw_if_failed();
    for_pieces(values, [&](std::span<std::byte> piece) { spread(piece, from); });
  }

  std::vector<std::vector<std::byte>> do_gather(std::span<const std::byte> values) override {
    throw_if_failed();
    auto length = static_cast<std::int64_t>(values.size());
    if (rank_ != 0) {
      send(&length, sizeof length, 0, gathers);
      for_pieces(values,
                 [&](std::span<const std::byte> piece) { send(piece.data(), count_of(piece), 0, gathers); });
      return {};
    }
    std::vector<std::vector<std::byte>> all(static_cast<std::size_t>(size_));
    all[0].assign(values.begin(), values.end());
    for (int from = 1; from < size_; ++from) {
      receive(&length, sizeof length, from, gathers);
      auto& part = all[static_cast<std::size_t>(from)];
      part.resize(static_cast<std::size_t>(length));
      for_pieces(std::span(part),
                 [&](std::span<std::byte> piece) { receive(piece.data(), count_of(piece), from, gathers); });
    }
    return all;
  }

  void do_begin_exchange(std::span<const message> sent, std::span<const message> received) override {
    throw_if_failed();
    exchange_.requests.clear();
    exchange_.requests.reserve(sent.size() + received.size());
    exchange_.received = received.size();
    for (const message& one : received)
      check_mpi(MPI_Irecv(one.numbers.data(), count_of(one.numbers), MPI_DOUBLE, one.rank, exchanges, all_,
                          &exchange_.requests.emplace_back()),
                "MPI_Irecv");
    for (const message& one : sent)
      check_mpi(MPI_Isend(one.numbers.data(), count_of(one.numbers), MPI_DOUBLE, one.rank, exchanges, all_,
                          &exchange_.requests.emplace_back()),
                "MPI_Isend");
  }
  void do_advance_exchange() override { exchange_.complete(); }
  void do_finish_exchange() override { wait(exchange_); }

  template <class Byte, class Body>
  static void for_pieces(std::span<Byte> values, const Body& body) {
    for (std::size_t at = 0; at < values.size(); at += longest_piece)
      body(values.subspan(at, std::min(longest_piece, values.size() - at)));
  }

  static constexpr int gathers = 1, exchanges = 2, reductions = 3, broadcasts = 4;  // tags
  static constexpr long turns_of_notice = 8, turns_of_signals = 1024, turns_of_spinning = 1000;
  static constexpr double delay_of_notice = 0.1,  ///< s; processes that fail together need no notice
      longest_withdrawal = 10.0;                  ///< s

  std::shared_ptr<void> session_;
  MPI_Comm all_ = MPI_COMM_NULL,
           ends_ = MPI_COMM_NULL;  ///< the second one for all_call_within() and failures
  int rank_ = 0, size_ = 1, here_ = 1, number_here_ = 0;
  pending exchange_, discarded_;
  std::vector<std::byte> unread_;
  std::unique_ptr<failure_notice> notice_;
};

/// Initializes MPI for the lifetime of the object.
struct mpi_session {
  mpi_session() {
    int provided = 0;
    // Loops have threads of their own; the main thread alone communicates.
    check_mpi(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "MPI_Init_thread");
  }
  ~mpi_session() { MPI_Finalize(); }
  mpi_session(const mpi_session&) = delete;
  mpi_session& operator=(const mpi_session&) = delete;
};

}  // namespace

bool has_mpi() {
  return true;
}

std::shared_ptr<communicator> launched_processes() {
  // A process that was started alone does not pay for the start of MPI.
  if (launched_count() == 1) return single_process();
  auto session = std::make_shared<mpi_session>();
  return std::make_shared<mpi_communicator>(MPI_COMM_WORLD, std::move(session));
}

std::shared_ptr<communicator> processes_of(int fortran_handle) {
  int initialized = 0;
  MPI_Initialized(&initialized);
  if (initialized == 0)
    throw input_error("an MPI communicator was given (MPI is not initialized); initialize it first");
  const MPI_Comm given = MPI_Comm_f2c(fortran_handle);
  if (given == MPI_COMM_NULL)
    throw input_error("the MPI communicator is MPI_COMM_NULL (it has no processes); give another one");
  return std::make_shared<mpi_communicator>(given);
}

}  // namespace apsis
