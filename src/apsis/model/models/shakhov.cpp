#include <apsis/model/formulas/shakhov.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/model/gas_model.hpp>
#include <apsis/model/gas_target.hpp>

#include <array>
#include <cmath>

namespace apsis {
namespace {

/// Shakhov's model (Fluid Dyn. 3, 1968) of a monatomic gas: Q = C (S − f) with
///   S = M [1 + (1 − Pr) q·c/(5pT) (|c|²/T − 5)],  c = v − u.
/// The heat flux q relaxes with the rate Pr C and the stress with C, so that the
/// Prandtl number is Pr. The bracket is negative in the tails. With model.tails = "nonnegative" the target is
/// cut off where the solution of a stage would be negative. A polynomial of second degree restores its
/// moments. Steps then keep f ≥ 0, but q relaxes at another rate (cut_moment()). Rows are reduced as in
/// gas.hpp. Dimensionless.
class shakhov_model final : public gas_model {
 public:
  explicit shakhov_model(const model_config& config)
      : gas_model(config), target_{config.parameters.at("prandtl")} {
    if (molecules().degrees_of_freedom() != 3)
      throw input_error(
          "model.degrees_of_freedom is not 3 (Shakhov's model is that of a monatomic gas); give 3");
  }

  /// No H-theorem is known far from equilibrium.
  std::optional<convex_entropy> entropy() const override {
    auto of_gas = gas_model::entropy();
    of_gas->collisions_decrease = false;
    return of_gas;
  }

  std::string cut_moment() const override { return "heat_flux"; }

  const scalar::shakhov_target* as_shakhov() const override { return &target_; }

  int relaxing_count() const override { return molecules().dimensions() + 1; }

  double moment_accuracy() const override { return target_accuracy; }

  /// s = (q, weight of Q̇).
  void relaxing_moments(const double* f, const double* omega, double* s) const override {
    const int d = molecules().dimensions();
    for (int k = 0; k <= d; ++k) s[k] = 0.0;
    const fluid_state state = molecules().state(omega);
    if (!state.admissible()) return;
    const central_moments m = compute_central_moments(molecules(), f, state);
    for (int k = 0; k < d; ++k) s[k] = m.heat[static_cast<std::size_t>(k)];
  }

  void relax(const stage_coefficients& of, double* s) const override {
    const int d = molecules().dimensions();
    const double decay = target_.decay(of);
    for (int k = 0; k < d; ++k) s[k] *= decay;
    s[d] = target_.weight_of_derivative(of);
  }

  bool target(const double* omega, const double* s, const double* f, double keep, double* e,
              double& cut) const override {
    const gas& g = molecules();
    const int d = g.dimensions();
    thread_local std::vector<double> base;
    base.resize(static_cast<std::size_t>(components()));
    target_base of{base.data(), {}};
    if (!g.equilibrium(omega, base.data(), of.moments)) return false;
    const fluid_state state = g.state(omega);
    if (!state.admissible()) {
      std::copy(base.begin(), base.end(), e);
      return true;
    }
    const auto with_part = [&](double part, double bound, double* row, bool& raised) {
      return conservative_target(g, omega, of, target_.shape(d, state, s, s[d], part), f, bound, row, raised);
    };
    return find_target(omega, s, rate_of_stage(target_.prandtl, s[d]), keep, e, cut, with_part);
  }

 private:
  scalar::shakhov_target target_;
};

}  // namespace

extern const model_entry model_shakhov;
const model_entry model_shakhov = {
    .name = "shakhov",
    .description = "f_t + v f_x = C (S[f] - f)/epsilon, a monatomic gas with a Prandtl number",
    .source = "Shakhov, Fluid Dyn. 3 (1968)",
    .has_velocity_grid = true,
    .parameters =
        [] {
          auto all = gas_model::parameters(3.0);
          all.push_back({.name = "prandtl",
                         .value = 2.0 / 3.0,
                         .lowest = 0.1,
                         .highest = 2.0,
                         .doc = "Prandtl number; 2/3 for a monatomic gas"});
          return all;
        }(),
    .options = gas_model::texts_with_tails("signed"),
    .make = [](const model_config& config) -> std::unique_ptr<model> {
      return std::make_unique<shakhov_model>(config);
    }};

}  // namespace apsis
