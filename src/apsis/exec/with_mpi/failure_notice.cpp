#include <apsis/exec/internal/with_mpi/failure_notice.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace apsis {

void check_mpi(int code, const char* what) {
  if (code == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(code, text.data(), &length);
  throw std::runtime_error(
      fmt::format("{} failed: {}", what, std::string(text.data(), static_cast<std::size_t>(length))));
}

failure_notice::failure_notice(MPI_Comm ends) : ends_(ends) {
  listen(received_, listening_);
}

failure_notice::~failure_notice() {
  if (listening_ == MPI_REQUEST_NULL) return;
  MPI_Cancel(&listening_);
  MPI_Wait(&listening_, MPI_STATUS_IGNORE);
}

void failure_notice::listen(packet& to, MPI_Request& request) {
  check_mpi(MPI_Irecv(&to, static_cast<int>(sizeof to), MPI_BYTE, MPI_ANY_SOURCE, 0, ends_, &request),
            "MPI_Irecv");
}

bool failure_notice::arrived() {
  if (arrived_ || listening_ == MPI_REQUEST_NULL) return arrived_;
  int done = 0;
  check_mpi(MPI_Test(&listening_, &done, MPI_STATUS_IGNORE), "MPI_Test");
  arrived_ = done != 0;
  return arrived_;
}

void failure_notice::raise(const packet& notice) {
  const std::string text(notice.text.data(), static_cast<std::size_t>(notice.head.length));
  raise_error(notice.head, fmt::format("process {}: {}", notice.rank, text));
}

failure_notice::packet failure_notice::packed(const std::exception_ptr& mine) const {
  if (arrived_) return received_;
  packet made;
  std::string text;
  made.head = describe(mine, text);
  text.resize(std::min(text.size(), longest_text));
  made.head.length = static_cast<std::int64_t>(text.size());
  std::copy(text.begin(), text.end(), made.text.begin());
  MPI_Comm_rank(ends_, &made.rank);
  return made;
}

void failure_notice::announce(const std::exception_ptr& mine) {
  sent_ = packed(mine);
  int size = 1;
  MPI_Comm_size(ends_, &size);
  for (int to = 0; to < size; ++to)
    if (to != sent_.rank)
      check_mpi(
          MPI_Isend(&sent_, static_cast<int>(sizeof sent_), MPI_BYTE, to, 0, ends_, &sending_.emplace_back()),
          "MPI_Isend");
}

void failure_notice::finish(const std::exception_ptr& mine) {
  int size = 1, rank = 0;
  MPI_Comm_size(ends_, &size);
  MPI_Comm_rank(ends_, &rank);
  const int announced = sending_.empty() ? 0 : 1, failed = mine ? rank : size;
  int announcements = 0, first = size;
  check_mpi(MPI_Allreduce(&announced, &announcements, 1, MPI_INT, MPI_SUM, ends_), "MPI_Allreduce");
  check_mpi(MPI_Allreduce(&failed, &first, 1, MPI_INT, MPI_MIN, ends_), "MPI_Allreduce");
  for (int expected = announcements - announced - (arrived_ ? 1 : 0); expected > 0; --expected) {
    packet further;
    if (listening_ == MPI_REQUEST_NULL) listen(further, listening_);
    check_mpi(MPI_Wait(&listening_, MPI_STATUS_IGNORE), "MPI_Wait");
  }
  check_mpi(MPI_Waitall(static_cast<int>(sending_.size()), sending_.data(), MPI_STATUSES_IGNORE),
            "MPI_Waitall");
  if (first == size) return;
  packet error;
  if (first == rank) error = packed(mine);
  check_mpi(MPI_Bcast(&error, static_cast<int>(sizeof error), MPI_BYTE, first, ends_), "MPI_Bcast");
  if (!mine) raise(error);
}

}  // namespace apsis
