#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/exec/communicator.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace apsis {

/// A row of numbers that a process has and another one needs.
struct shared_row {
  int key,   ///< its number, known to all processes
      from,  ///< who has it
      to;    ///< who needs it
  /// In the order in which rows are sent: by process, then by key.
  auto operator<=>(const shared_row&) const = default;
};

/// Single rows that processes send to each other: those of neighbours that no halo_exchange has.
class shared_rows {
 public:
  /// Nothing is sent.
  shared_rows() = default;
  /// `all`: the rows of all processes, equal on all of them; one may stand there several times.
  shared_rows(std::shared_ptr<communicator> processes, std::vector<shared_row> all);

  /// Sends rows of `length` numbers; row_of(key) is a row that this process has. Collective.
  void exchange(int length, const std::function<const double*(int key)>& row_of);
  /// Returns the place of a row that this process needs among those received. Throws std::out_of_range for
  /// another row.
  int place_of(int key) const;
  /// Returns a row of the last exchange.
  const double* row(int place) const {
    return received_.data() + static_cast<std::size_t>(place) * static_cast<std::size_t>(length_);
  }

 private:
  struct peer {
    int rank;
    std::vector<int> given, wanted;  ///< keys, increasing
  };

  std::shared_ptr<communicator> processes_;
  bool any_ = false;
  std::vector<peer> peers_;
  int length_ = 0;
  aligned_vector<double> sent_, received_;
};

}  // namespace apsis
