#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/device/device.hpp>
#include <apsis/device/internal/device_array.hpp>
#include <apsis/device/internal/surface_rows.hpp>
#include <apsis/device/internal/sweep.hpp>
#include <apsis/semidiscrete/block_sweep.hpp>

#include <string>

namespace apsis {

/// The segments of one direction on a device, and the speeds along it.
class swept_segments {
 public:
  /// `halo`: number of cells beyond a piece whose edge values fluxes need; `ghosts`: number of rows beyond
  /// each end.
  swept_segments(device& on, const domain& space, const surface_rows& surfaces, int direction, int halo,
                 int ghosts);

  /// Sets the speeds of the components.
  void set_speeds(const line_speeds& of);
  /// Starts the sweep `kernel`. The caller sets the states and targets in `arguments`; this function sets the
  /// other members.
  void sweep(const std::string& kernel, kernels::sweep_arguments arguments) const;

 private:
  device& device_;
  int apart_, ghosts_, pieces_count_ = 0;
  device_array<kernels::swept_segment> segments_;
  device_array<kernels::piece_of_segment> pieces_;
  device_array<int> beyond_;
  device_array<double> per_cell_, forward_, inverse_cfl_;
};

}  // namespace apsis
