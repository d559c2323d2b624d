#pragma once

#include <apsis/device/device.hpp>
#include <apsis/device/internal/device_array.hpp>
#include <apsis/semidiscrete/cut_transport.hpp>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// Transport in cut cells of a state on a device, with the bits of the host. The host evaluates it from a
/// mirror, a field on the host with the rows of cut_transport::cells_read().
class device_cut_cells {
 public:
  /// `on`, `equation` and `faces` must outlive the object; the other arguments are those of cut_transport.
  device_cut_cells(device& on, const model& equation, const std::shared_ptr<domain>& space,
                   const limited_reconstruction& edges, face_fluxes& faces);

  /// Returns transport in cut cells on the host.
  cut_transport& on_host() { return host_; }
  /// Adds α u + β T to the targets in cut cells, after the values at surfaces are recorded. Collective.
  void add(double t, const field& mirror, const field& u, std::span<const target<field, double>> targets);

 private:
  device& device_;
  cut_transport host_;
  std::size_t stride_;
  std::vector<int> row_of_;                 ///< row of T of each cell; −1 for whole cells
  device_array<std::array<int, 2>> cells_;  ///< in the layout of kernels::add_rates
  std::vector<double> rates_;               ///< rows of T, one for each group
  stored_numbers rates_on_device_;
};

}  // namespace apsis
