#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/exec/communicator.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace apsis {

/// A row of numbers that one process has and another process needs.
struct shared_row {
  int key,   ///< number of the row, the same on all processes
      from,  ///< process that has the row
      to;    ///< process that needs the row
  /// Orders rows by key, then by the processes `from` and `to`.
  auto operator<=>(const shared_row&) const = default;
};

/// Single rows that processes send to each other, in addition to those of a halo_exchange.
class shared_rows {
 public:
  /// Makes an exchange without rows.
  shared_rows() = default;
  /// Takes the rows of all processes. The list must be the same on all processes and may repeat rows.
  shared_rows(std::shared_ptr<communicator> processes, std::vector<shared_row> all);

  /// Sends and receives rows of `length` numbers. row_of(key) returns a row that this process
  /// has. Collective.
  void exchange(int length, const std::function<const double*(int key)>& row_of);
  /// Returns the place, among the received rows, of a row that this process needs. Throws std::out_of_range
  /// for other rows.
  int place_of(int key) const;
  /// Returns a row that the last exchange() received, by place_of() its key.
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
