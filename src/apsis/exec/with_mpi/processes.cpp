#include <apsis/exec/processes.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/launcher.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <mpi.h>

namespace apsis {
namespace {

/// MPI counts with int: longer data are sent in pieces.
constexpr std::size_t longest_piece = std::size_t{1} << 30U;

void check(int code, const char* what) {
  if (code == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(code, text.data(), &length);
  throw std::runtime_error(
      fmt::format("{} failed: {}", what, std::string(text.data(), static_cast<std::size_t>(length))));
}

template <class T>
int count_of(std::span<T> values) {
  if (values.size() > longest_piece) throw std::length_error("a message of more than 2^30 numbers");
  return static_cast<int>(values.size());
}

/// A duplicate of an MPI communicator. `session` finalizes MPI after it, if this program initialized it.
class mpi_communicator final : public communicator {
 public:
  explicit mpi_communicator(MPI_Comm of, std::shared_ptr<void> session = nullptr)
      : session_(std::move(session)) {
    check(MPI_Comm_dup(of, &all_), "MPI_Comm_dup");
    check(MPI_Comm_dup(of, &ends_), "MPI_Comm_dup");
    MPI_Comm_rank(all_, &rank_);
    MPI_Comm_size(all_, &size_);
    MPI_Comm here = MPI_COMM_NULL;
    check(MPI_Comm_split_type(all_, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here), "MPI_Comm_split_type");
    MPI_Comm_size(here, &here_);
    MPI_Comm_free(&here);
  }
  ~mpi_communicator() override {
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (finalized != 0) return;
    MPI_Comm_free(&all_);
    MPI_Comm_free(&ends_);
  }
  mpi_communicator(const mpi_communicator&) = delete;
  mpi_communicator& operator=(const mpi_communicator&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int processes_here() const override { return here_; }
  std::int64_t handle() const override { return MPI_Comm_c2f(all_); }
  bool all_arrive(double seconds) override {
    MPI_Request request = MPI_REQUEST_NULL;
    check(MPI_Ibarrier(ends_, &request), "MPI_Ibarrier");
    const auto begun = std::chrono::steady_clock::now();
    for (;;) {
      int arrived = 0;
      check(MPI_Test(&request, &arrived, MPI_STATUS_IGNORE), "MPI_Test");
      if (arrived != 0) return true;
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count() > seconds)
        return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  [[noreturn]] void abort(int code) const override {
    MPI_Abort(all_, code);
    std::_Exit(code);
  }

 private:
  void do_sum(std::span<std::int64_t> values) override {
    check(MPI_Allreduce(MPI_IN_PLACE, values.data(), count_of(values), MPI_INT64_T, MPI_SUM, all_),
          "MPI_Allreduce");
  }
  void do_lowest(std::span<double> values) override {
    check(MPI_Allreduce(MPI_IN_PLACE, values.data(), count_of(values), MPI_DOUBLE, MPI_MIN, all_),
          "MPI_Allreduce");
  }
  void do_broadcast(std::span<std::byte> values, int from) override {
    for_pieces(values, [&](std::byte* piece, int bytes) {
      check(MPI_Bcast(piece, bytes, MPI_BYTE, from, all_), "MPI_Bcast");
    });
  }

  std::vector<std::vector<std::byte>> do_gather(std::span<const std::byte> values) override {
    const auto length = static_cast<std::int64_t>(values.size());
    std::vector<std::int64_t> lengths(rank_ == 0 ? static_cast<std::size_t>(size_) : 0);
    check(MPI_Gather(&length, 1, MPI_INT64_T, lengths.data(), 1, MPI_INT64_T, 0, all_), "MPI_Gather");
    if (rank_ != 0) {
      for_pieces(values, [&](const std::byte* piece, int bytes) {
        check(MPI_Send(piece, bytes, MPI_BYTE, 0, gathers, all_), "MPI_Send");
      });
      return {};
    }
    std::vector<std::vector<std::byte>> all(lengths.size());
    all[0].assign(values.begin(), values.end());
    for (int from = 1; from < size_; ++from) {
      auto& part = all[static_cast<std::size_t>(from)];
      part.resize(static_cast<std::size_t>(lengths[static_cast<std::size_t>(from)]));
      for_pieces(std::span(part), [&](std::byte* piece, int bytes) {
        check(MPI_Recv(piece, bytes, MPI_BYTE, from, gathers, all_, MPI_STATUS_IGNORE), "MPI_Recv");
      });
    }
    return all;
  }

  void do_begin_exchange(std::span<const message> sent, std::span<const message> received) override {
    requests_.clear();
    requests_.reserve(sent.size() + received.size());
    for (const message& one : received)
      check(MPI_Irecv(one.numbers.data(), count_of(one.numbers), MPI_DOUBLE, one.rank, exchanges, all_,
                      &requests_.emplace_back()),
            "MPI_Irecv");
    for (const message& one : sent)
      check(MPI_Isend(one.numbers.data(), count_of(one.numbers), MPI_DOUBLE, one.rank, exchanges, all_,
                      &requests_.emplace_back()),
            "MPI_Isend");
  }
  void do_advance_exchange() override {
    int all_done = 0;
    if (!requests_.empty())
      check(MPI_Testall(static_cast<int>(requests_.size()), requests_.data(), &all_done, MPI_STATUSES_IGNORE),
            "MPI_Testall");
    if (all_done != 0) requests_.clear();
  }
  void do_finish_exchange() override {
    if (requests_.empty()) return;
    check(MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE),
          "MPI_Waitall");
    requests_.clear();
  }

  template <class Byte, class Body>
  static void for_pieces(std::span<Byte> values, const Body& body) {
    for (std::size_t at = 0; at < values.size(); at += longest_piece)
      body(values.data() + at, static_cast<int>(std::min(longest_piece, values.size() - at)));
  }

  static constexpr int gathers = 1, exchanges = 2;  // tags

  std::shared_ptr<void> session_;
  MPI_Comm all_ = MPI_COMM_NULL, ends_ = MPI_COMM_NULL;  ///< the second one for all_arrive()
  int rank_ = 0, size_ = 1, here_ = 1;
  std::vector<MPI_Request> requests_;
};

/// Initializes MPI for the lifetime of the object.
struct mpi_session {
  mpi_session() {
    int provided = 0;
    // Loops have threads of their own; the main thread alone communicates.
    check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "MPI_Init_thread");
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
