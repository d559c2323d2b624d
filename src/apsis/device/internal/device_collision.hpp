#pragma once

#include <apsis/device/device.hpp>
#include <apsis/device/internal/collision_stage.hpp>
#include <apsis/device/internal/device_array.hpp>
#include <apsis/device/internal/device_gas_rows.hpp>
#include <apsis/device/internal/launch_room.hpp>
#include <apsis/model/gas_model.hpp>
#include <apsis/semidiscrete/collision.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// make_pointwise_collision() on a device, with the same bits. It solves stages of the BGK, Shakhov and
/// ellipsoidal models on velocity grids that are products of lines. The host solves the other cells, row by
/// row: their target is cut off, or Newton's method does not find their equilibrium from a Gaussian.
///
/// States are stored in the memory of the device.
class device_collision final : public collision {
 public:
  /// `on` and `equation` must outlive the operator. The other arguments are those of
  /// make_pointwise_collision(). Throws input_error if why_not() returns a reason.
  device_collision(device& on, const model& equation, std::vector<double> epsilon, bool keeps_sign,
                   std::vector<cell_range> cells, stage_solution stages);

  /// Returns why collisions cannot run on a device, as a clause; "" if they can.
  static std::string why_not(const model& equation, stage_solution stages);

  void solve(double t, double a, double b, field& u) override;
  /// Runs on the host, with copies of the states.
  void add_collision(double t, const field& u, std::span<const target<field, double>> targets) override;
  /// Runs on the host, with a copy of the state.
  double forward_euler_step(const field& u) const override;
  /// Runs on the host, with a copy of the state.
  double relaxation_time(const field& u) const override;
  double take_cut() override;
  /// Returns how many cells the host has solved in all stages so far.
  long solved_on_host() const { return solved_on_host_; }

 private:
  void launch(const kernels::collision_stage& stage);
  void solve_rest(double a, double b, const cell_range& cells, field& u);

  device& device_;
  const gas_model& gas_;
  std::vector<double> epsilon_;
  std::vector<cell_range> cells_;
  std::unique_ptr<collision> host_;
  std::unique_ptr<point_collision> rest_;
  device_gas_rows rows_;
  device_array<double> epsilon_on_device_;
  stored_numbers marks_;
  std::vector<double> marks_on_host_;
  launch_room room_;
  long solved_on_host_ = 0;
};

}  // namespace apsis
