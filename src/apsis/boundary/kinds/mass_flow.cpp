#include <apsis/boundary/gas_end.hpp>
#include <apsis/boundary/limited_flow.hpp>
#include <apsis/boundary/prescribed_state.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace apsis {
namespace {

/// A given mass flux m through every face, into the gas if m > 0. The Maxwellian ρ M[1, u, T] enters with
///   ρ = (m + Σ_out w |v_n| f)/Σ_in w |v_n| M.
/// These are the discrete sums of the fluxes in the step, so that the net flux is m to rounding, and f ≥ 0 if
/// ρ ≥ 0. The velocity along the normal is m/ρ_i, at most the speed of sound, with the density ρ_i inside.
/// Gas that enters has the temperature of the boundary and no velocity along the face. Gas that leaves has
/// temperature and velocity along the face from inside. In a continuum ρ is then that of the gas inside,
/// without a kinetic layer. Nothing enters if the flux of an outlet exceeds the arriving one. A total flow is
/// the flux m = flow/area through every face of the surface.
class mass_flow_end final : public gas_end, public limited_flow {
 public:
  /// `is_total` is true if `flow` is the flow through the whole surface, not per area.
  mass_flow_end(const model& equation, face_quantity flow, bool is_total, face_quantity temperature)
      : gas_end(equation, "mass-flow"),
        flow_(std::move(flow)),
        is_total_(is_total),
        temperature_(std::move(temperature)) {}

  std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const override {
    auto own = std::make_shared<mass_flow_end>(*this);
    own->short_ = std::make_shared<std::atomic<bool>>(false);
    const std::vector<double> inward = inward_speeds(where, velocities);
    own->mass_flux_.assign(velocities.weights().begin(), velocities.weights().end());
    for (std::size_t j = 0; j < own->mass_flux_.size(); ++j) own->mass_flux_[j] *= inward[j];  // > 0: enters
    return own;
  }

  std::shared_ptr<const boundary> on_surface(const std::function<double()>& area) const override {
    if (!is_total_) return nullptr;
    auto own = std::make_shared<mass_flow_end>(*this);
    own->area_ = area();
    if (!(own->area_ > 0.0))
      throw input_error(
          "'total_flow' is given at a side without an open face (bodies or solid boxes cover it); open a "
          "part "
          "of it, or choose another boundary");
    return own;
  }

  bool take_shortfall() const override { return short_->exchange(false); }

 private:
  fluid_state outside(const fluid_state& inside, const face& where, double t,
                      const position& at) const override {
    const double m = flux(t, at), T = temperature_.at(t, at);
    const bool empty = !inside.admissible();
    fluid_state state;
    if (m < 0.0 && !empty) {
      state = inside;
    } else {
      state.rho = empty ? 1.0 : inside.rho;  // adjust() replaces it
      state.T = T;
    }
    if (!(state.T > 0.0)) return state;  // refused, because no gas has this state
    const double fastest = sound(state.T), speed = empty ? fastest : std::abs(m) / inside.rho;
    set_outward(state, where, std::copysign(std::min(speed, fastest), -m));
    return state;
  }

  void adjust(const face&, double t, const position& at, const double* outgoing,
              double* incoming) const override {
    double arriving = 0.0, entering = 0.0;
    for (std::size_t j = 0; j < mass_flux_.size(); ++j) {
      if (mass_flux_[j] < 0.0) arriving -= mass_flux_[j] * outgoing[j];
      if (mass_flux_[j] > 0.0) entering += mass_flux_[j] * incoming[j];
    }
    const double needed = flux(t, at) + arriving;
    if (needed < 0.0) short_->store(true, std::memory_order_relaxed);
    const double scale = needed > 0.0 && entering > 0.0 ? needed / entering : 0.0;
    for (int k = 0; k < molecules().velocities().components(); ++k) incoming[k] *= scale;
  }

  double flux(double t, const position& at) const { return flow_.at(t, at) / area_; }

  face_quantity flow_;
  bool is_total_;
  double area_ = 1.0;  ///< area of the surface, for a total flow
  face_quantity temperature_;
  std::vector<double> mass_flux_;             ///< fluxes of unit components of the first set; > 0 enters
  std::shared_ptr<std::atomic<bool>> short_;  ///< whether a flux fell short; take_shortfall() clears it
};

}  // namespace

extern const boundary_entry boundary_mass_flow;
const boundary_entry boundary_mass_flow = {
    .name = "mass-flow",
    .description = "inlet or outlet of given mass flux or total mass flow, reached exactly at every face",
    .variables =
        [](const model& equation) {
          maxwellian_form(equation, "mass-flow");
          return std::vector<data_variable>{
              {.name = "flux",
               .doc = "mass flux into the gas, < 0 where it leaves (dimensionless)",
               .dimension = dimensions::mass_flux,
               .alternative = "total_flow"},
              {.name = "total_flow",
               .doc = "mass flow into the gas through the whole side in place of flux (dimensionless)",
               .dimension = dimensions::mass_flux,
               .alternative = "flux",
               .over_surface = true},
              {.name = "T",
               .doc = "temperature of the gas that enters, > 0 (dimensionless)",
               .value = 1.0,
               .dimension = dimensions::temperature}};
        },
    .make = [](const boundary_source& from) -> std::unique_ptr<boundary> {
      const bool is_total = from.is_given("total_flow");
      return std::make_unique<mass_flow_end>(*from.equation, from.values[is_total ? 1 : 0], is_total,
                                             from.values[2]);
    }};

}  // namespace apsis
