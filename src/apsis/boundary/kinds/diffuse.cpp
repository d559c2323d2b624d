#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/mirrored_components.hpp>
#include <apsis/boundary/prescribed_state.hpp>
#include <apsis/core/errors.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// A wall of temperature T that moves along itself (Maxwell 1879): of the molecules that arrive, the fraction
/// α leaves with the Maxwellian of the wall and 1 − α is reflected specularly,
///   f_in = α ρ_w M[1, u_w, T_w] + (1 − α) f_out(mirrored v_n),  ρ_w = Σ_out w |v_n| f / Σ_in w |v_n| M,
/// with the discrete sums of the fluxes in the step, so that no mass crosses the wall.
class diffuse_wall final : public incoming_boundary {
 public:
  diffuse_wall(prescribed_state emitted, std::vector<face_quantity> velocity, face_quantity accommodation)
      : emitted_(std::move(emitted)),
        velocity_(std::move(velocity)),
        accommodation_(std::move(accommodation)) {}

  std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const override {
    auto own = std::make_shared<diffuse_wall>(*this);
    own->mirrored_ = mirrored_components(velocities, where.direction);
    own->mass_flux_.assign(velocities.weights().begin(), velocities.weights().end());
    for (std::size_t j = 0; j < own->mass_flux_.size(); ++j) {
      const double v = velocities.speeds(where.direction)[j];
      own->mass_flux_[j] *= where.upper ? -v : v;  // > 0: enters
    }
    return own;
  }

  void incoming(const face& where, double t, const position& at, const double* outgoing,
                double* values) const override {
    const double normal = velocity_[static_cast<std::size_t>(where.direction)].at(t, at);
    if (normal != 0.0)
      throw input_error(
          fmt::format("the velocity of a diffuse wall is {:g} along its normal at t = {:.10g} (the "
                      "domain would have to move); give 0 there",
                      normal, t));
    const double alpha = accommodation_.at(t, at);
    if (!(alpha >= 0.0 && alpha <= 1.0))
      throw input_error(
          fmt::format("the accommodation of a diffuse wall is {:g} at t = {:.10g} (a number "
                      "from 0 to 1 is needed); change it",
                      alpha, t));
    std::vector<double> buffer(mirrored_.size());
    const double* emitted = emitted_.at(t, at, buffer);
    double arriving = 0.0, leaving = 0.0;
    for (std::size_t j = 0; j < mass_flux_.size(); ++j) {
      if (mass_flux_[j] < 0.0) arriving -= mass_flux_[j] * outgoing[j];
      if (mass_flux_[j] > 0.0) leaving += mass_flux_[j] * emitted[j];
    }
    const double rho = alpha * (arriving / leaving);
    for (std::size_t k = 0; k < mirrored_.size(); ++k)
      values[k] = rho * emitted[k] + (1.0 - alpha) * outgoing[mirrored_[k]];
  }

 private:
  prescribed_state emitted_;
  std::vector<face_quantity> velocity_;
  face_quantity accommodation_;
  std::vector<int> mirrored_;      ///< component whose normal velocity is opposite
  std::vector<double> mass_flux_;  ///< of unit components of the first set; > 0 enters
};

}  // namespace

extern const boundary_entry boundary_diffuse;
const boundary_entry boundary_diffuse = {
    .name = "diffuse",
    .description =
        "wall that re-emits molecules with its temperature and velocity, or reflects a part of them",
    .variables =
        [](const model& equation) {
          const int d = maxwellian_form(equation, "diffuse").variables[1].size;
          return std::vector<data_variable>{
              {"T", "temperature of the wall, > 0 (dimensionless)", 1, 1.0, dimensions::temperature},
              {"velocity", "velocity of the wall, 0 along its normal (dimensionless)", d, 0.0,
               dimensions::velocity},
              {"accommodation", "fraction of molecules that is re-emitted, 0 to 1; the others are reflected",
               1, 1.0}};
        },
    .make = [](const boundary_source& from) -> std::unique_ptr<boundary> {
      const std::vector<face_quantity> velocity(from.values.begin() + 1, from.values.end() - 1);
      std::vector<face_quantity> state = {1.0};  // of density 1
      state.insert(state.end(), velocity.begin(), velocity.end());
      state.push_back(from.values.front());
      return std::make_unique<diffuse_wall>(prescribed_state(maxwellian_form(*from.equation, "diffuse"),
                                                             std::move(state), from.equation->components()),
                                            velocity, from.values.back());
    }};

}  // namespace apsis
