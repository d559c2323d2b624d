#pragma once

#include <apsis/device/device.hpp>
#include <apsis/device/internal/device_gas_rows.hpp>
#include <apsis/device/internal/launch_room.hpp>
#include <apsis/model/gas_model.hpp>
#include <apsis/semidiscrete/force.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// `force` on a device, with the same bits. The host evaluates the accelerations.
class device_force {
 public:
  /// `on` and `gas` must outlive the object; the arguments are those of `force`.
  device_force(device& on, const gas_model& gas, std::shared_ptr<domain> space, acceleration of,
               const limited_reconstruction& edges);

  /// Does the same as force::add(), for states on the device. Collective, even if a process fails.
  void add(double t, const field& u, std::span<const target<field, double>> targets);
  /// Returns the force on the host, with given() and losses() of the last add().
  force& on_host() { return host_; }
  /// Returns the force on the host.
  const force& on_host() const { return host_; }

 private:
  void set_accelerations(double t);
  void change(const field& u, std::span<const target<field, double>> targets);

  device& device_;
  std::shared_ptr<domain> space_;
  velocity_lattice lattice_;
  force host_;
  device_gas_rows rows_;
  device_array<double> weights_;
  std::vector<cell_range> cells_;
  std::vector<double> accelerations_;  ///< three components of every cell
  std::vector<double> sums_on_host_;
  stored_numbers accelerations_on_device_, sums_;
  int components_, most_lines_;
  launch_room room_;
};

}  // namespace apsis
