#include <apsis/boundary/gas_end.hpp>
#include <apsis/boundary/prescribed_state.hpp>

#include <cmath>
#include <utility>

namespace apsis {
namespace {

/// A gas that is at rest or in uniform motion far away. The leaving Riemann invariants of the Euler
/// equations, u_n + 2a/(γ − 1), are those of the gas inside. The entering one, u_n − 2a/(γ − 1), is that of
/// the state far away. Entropy and tangential velocity are those of the gas upstream. Gas that is subsonic
/// upstream crosses the face at most at the speed of sound, which it reaches in the middle of a rarefaction.
/// Waves leave with little reflection. In uniform gas this is the boundary condition inflow.
class far_field final : public gas_end {
 public:
  far_field(const model& equation, std::vector<face_quantity> values)
      : gas_end(equation, "far-field"), values_(std::move(values)) {}

 private:
  fluid_state outside(const fluid_state& inside, const face& where, double t,
                      const position& at) const override {
    fluid_state far;
    far.rho = values_.front().at(t, at);
    for (std::size_t k = 1; k + 1 < values_.size(); ++k) far.u[k - 1] = values_[k].at(t, at);
    far.T = values_.back().at(t, at);
    if (!far.admissible() || !inside.admissible()) return far;
    const double un_inside = outward(inside, where), un_far = outward(far, where),
                 rise = 2.0 / (gamma() - 1.0);
    if (un_inside >= sound(inside.T)) return inside;
    if (un_far <= -sound(far.T)) return far;
    const double leaving = un_inside + rise * sound(inside.T), entering = un_far - rise * sound(far.T);
    double speed = 0.5 * (leaving + entering), a = (leaving - entering) / (2.0 * rise);
    if (!(std::abs(speed) <= a)) {
      // The face lies in a rarefaction of the gas upstream, at its sonic point.
      const double invariant = speed > 0.0 ? leaving : -entering;
      if (!(invariant > 0.0)) return far;  // both gases recede faster than they can expand: vacuum
      a = invariant / (1.0 + rise);
      speed = std::copysign(a, speed);
    }
    fluid_state state = speed > 0.0 ? inside : far;
    const double T = a * a / gamma();
    state.rho *= std::pow(T / state.T, 1.0 / (gamma() - 1.0));  // same entropy p/ρ^γ
    state.T = T;
    set_outward(state, where, speed);
    return state;
  }

  std::vector<face_quantity> values_;
};

}  // namespace

extern const boundary_entry boundary_far_field;
const boundary_entry boundary_far_field = {
    .name = "far-field",
    .description = "gas in a given state far away: waves leave with little reflection",
    .variables = [](const model& equation) { return maxwellian_form(equation, "far-field").variables; },
    .make = [](const boundary_source& from) -> std::unique_ptr<boundary> {
      return std::make_unique<far_field>(*from.equation, from.values);
    }};

}  // namespace apsis
