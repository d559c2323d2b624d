#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/device/device.hpp>
#include <apsis/device/internal/device_force.hpp>
#include <apsis/device/internal/device_source.hpp>
#include <apsis/device/internal/surface_rows.hpp>
#include <apsis/device/internal/swept_segments.hpp>
#include <apsis/semidiscrete/upwind_transport.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace apsis {

class first_error;

/// Returns the name of the kernel for a reconstruction, such as "sweep_weno5_z" for "weno5-z". Throws
/// input_error if this kernel is missing.
std::string kernel_of_reconstruction(const std::string& name);

/// upwind_transport on a device, with the same bits. The host evaluates boundaries and cut cells with the
/// rows next to them.
///
/// States are stored in the memory of the device.
class device_transport final : public transport {
 public:
  /// `on`, `equation` and `unknown` must outlive the operator. `kernel` is kernel_of_reconstruction() of the
  /// scheme of `edges`. Throws input_error if why_not() returns a reason.
  device_transport(device& on, const model& equation, std::shared_ptr<domain> space,
                   limited_reconstruction edges, const cell_unknown& unknown, std::string kernel);

  /// Returns why transport cannot run on a device, as a clause; "" if it can.
  static std::string why_not(const model& equation, const limited_reconstruction& edges);

  /// Does not fuse the stage: does not call `then`, and returns false.
  bool add_transport(double t, const field& u, std::span<const target<field, double>> targets,
                     const cells_job& then = {}) const override;
  void combine(std::span<const linear_term<field, double>> terms, field& sum) const override;
  std::span<const double> budget_rates() const override { return surfaces_.rates(); }
  std::vector<double> observe_surfaces(double t, const field& u) const override;

  /// Throws input_error unless the model is a gas on a product of velocity lines, and the errors of `force`.
  void set_force(acceleration of) override;
  /// Throws input_error, because the kernel for rotations is missing.
  void set_rotation(int radial) override;
  void set_source(source_rate rate) override;

  double forward_euler_step() const override { return host_.forward_euler_step(); }
  void limit_for_steps(double share) override;
  void limit_for_steady_states(double collisions) override;
  double growth_of_source(double t, const field& u) const override {
    return source_depends_on_state() ? source_->growth(t, u) : 0.0;
  }
  bool source_depends_on_state() const override { return source_ && source_->on_host().depends_on_state(); }

 private:
  void add_inside(double t, const field& u, std::span<const target<field, double>> targets,
                  first_error& failure) const;
  void sweep_all(double t, const field& u, std::span<const target<field, double>> targets) const;
  void sweep(int direction, const field& u, std::span<const target<field, double>> targets) const;

  device& device_;
  const model& equation_;
  std::shared_ptr<domain> space_;
  limited_reconstruction edges_;
  const cell_unknown& unknown_;
  std::string kernel_;
  upwind_transport host_;  ///< for step sizes
  mutable surface_rows surfaces_;
  std::vector<swept_segments> along_;  ///< [direction]
  std::vector<line_speeds> speeds_;
  std::unique_ptr<device_force> force_;
  std::unique_ptr<device_source> source_;
  double share_ = 1.0;  ///< argument of limit_for_steps()
};

}  // namespace apsis
