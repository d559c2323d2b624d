#include <apsis/boundary/gas_end.hpp>
#include <apsis/boundary/prescribed_state.hpp>

#include <algorithm>
#include <utility>

namespace apsis {
namespace {

/// A reservoir of given pressure p (Wang & Li, Int. J. Heat Fluid Flow 25, 2004, for channels). The leaving
/// characteristic of the Euler equations gives the velocity u_n = u_n,i + (p_i − p)/(ρ_i a_i), with index i
/// inside. Gas that leaves has the density ρ_i + (p − p_i)/a_i². Gas that enters has the temperature T of the
/// reservoir and no velocity along the face; its speed is at most its speed of sound. Gas that leaves faster
/// than sound keeps its state.
class pressure_end final : public gas_end {
 public:
  pressure_end(const model& equation, face_quantity pressure, face_quantity temperature)
      : gas_end(equation, "pressure"), pressure_(std::move(pressure)), temperature_(std::move(temperature)) {}

 private:
  fluid_state outside(const fluid_state& inside, const face& where, double t,
                      const position& at) const override {
    const double p = pressure_.at(t, at), T = temperature_.at(t, at);
    fluid_state state;
    if (!(p > 0.0 && T > 0.0)) return state;  // refused, because no gas has this state
    const bool empty = !inside.admissible();  // gas fills a vacuum at the speed of sound
    const double a = empty ? 0.0 : sound(inside.T), un = outward(inside, where),
                 difference = p - inside.rho * inside.T;
    if (!empty && un >= a) return inside;
    const double speed = empty ? -sound(T) : un - difference / (inside.rho * a);
    if (speed < 0.0) {
      state.T = T;
      state.rho = p / T;
      set_outward(state, where, std::max(speed, -sound(T)));
      return state;
    }
    state = inside;
    state.rho += difference / (a * a);
    state.T = p / state.rho;
    set_outward(state, where, speed);
    return state;
  }

  face_quantity pressure_, temperature_;
};

}  // namespace

extern const boundary_entry boundary_pressure;
const boundary_entry boundary_pressure = {
    .name = "pressure",
    .description =
        "reservoir of given pressure, from which gas enters at its temperature, or into which it leaves",
    .variables =
        [](const model& equation) {
          maxwellian_form(equation, "pressure");
          return std::vector<data_variable>{
              {"p", "pressure of the reservoir, > 0 (dimensionless)", 1, {}, dimensions::pressure},
              {"T", "temperature of the gas that enters, > 0 (dimensionless)", 1, 1.0,
               dimensions::temperature}};
        },
    .make = [](const boundary_source& from) -> std::unique_ptr<boundary> {
      return std::make_unique<pressure_end>(*from.equation, from.values[0], from.values[1]);
    }};

}  // namespace apsis
