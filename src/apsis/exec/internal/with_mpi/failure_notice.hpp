#pragma once

#include <apsis/exec/sent_error.hpp>

#include <array>
#include <exception>
#include <vector>

#include <mpi.h>

namespace apsis {

/// Throws std::runtime_error with the text of MPI if a call failed.
void check_mpi(int code, const char* what);

/// Sends the error of a process that fails alone to the processes that wait for it.
class failure_notice {
 public:
  /// Listens on a communicator that carries no other messages.
  explicit failure_notice(MPI_Comm ends);
  ~failure_notice();
  failure_notice(const failure_notice&) = delete;
  failure_notice& operator=(const failure_notice&) = delete;

  /// Whether another process has announced its error.
  bool arrived();
  /// Whether this process has received or sent an announcement.
  bool known() const { return arrived_ || !sending_.empty(); }
  /// Throws the announced error with the rank of its process.
  [[noreturn]] void raise() const { raise(received_); }
  /// Sends the error of this process to all others.
  void announce(const std::exception_ptr& mine);
  /// Receives all announcements, and throws the error of the lowest rank if this process has none.
  /// Collective.
  void finish(const std::exception_ptr& mine);

 private:
  static constexpr std::size_t longest_text = 1024;
  struct packet {
    sent_error head;
    int rank = 0;
    std::array<char, longest_text> text{};
  };

  [[noreturn]] static void raise(const packet& notice);
  packet packed(const std::exception_ptr& mine) const;
  void listen(packet& to, MPI_Request& request);

  MPI_Comm ends_;
  packet received_, sent_;
  MPI_Request listening_ = MPI_REQUEST_NULL;
  std::vector<MPI_Request> sending_;
  bool arrived_ = false;
};

}  // namespace apsis
