#pragma once

#include <apsis/run/setup.hpp>

#include <string>
#include <vector>

namespace apsis {

/// The large allocations of a run: buffers of a step, copies of the state for results, and snapshots of the
/// fields. In several dimensions there are also rows at surfaces and slopes of cut cells, in a steady run the
/// moment equations. Smaller allocations are not counted, nor those that a run omits if memory is short
/// (loss_watch). A case that fits is therefore never refused.
class memory_need {
 public:
  /// Counts the allocations of a run with `copies` copies of the state.
  memory_need(const run_setup& setup, int copies);

  /// Returns the number of bytes.
  double bytes() const { return bytes(cells_, components_); }
  /// Returns "1.2 GB of memory (16 x 12 cells x 144 unknowns)".
  std::string text() const;

  /// Returns the largest space.cells of the same shape that fits into `limit` bytes; empty if none does.
  std::vector<int> cells_that_fit(double limit) const;
  /// Returns the largest velocity.points of the same shape that fit into `limit` bytes. The list is empty if
  /// fewer than 4 would fit, or if the case has no such points.
  std::vector<int> points_that_fit(double limit) const;

 private:
  double bytes(double cells, double components) const;
  std::string unknowns() const;

  std::vector<int> shape_,  ///< cells in each direction; empty without space
      points_;  ///< velocities of each direction, or one number for all; empty without velocity.points
  double cells_ = 1.0, components_;  ///< cells in all, components of a cell
  int velocity_dimensions_ = 0, buffers_, copies_;
  double snapshots_, fields_;
  double rows_at_surfaces_ = 0.0;  ///< ghost rows, values at faces, and slopes of cut cells
  double bytes_of_moments_ = 0.0;  ///< bytes per cell, for the moment equations of a steady run
  std::string method_;
};

/// Throws input_error at the place of space.cells if a run needs more than the available memory
/// (available_memory). The message gives the numbers of cells and of velocities that would fit. Call this
/// function before any large allocation.
void check_memory(const run_setup& setup, int copies);
/// Throws io_error if the device of a run has too little free memory for its states.
void check_device_memory(const run_setup& setup);

}  // namespace apsis
