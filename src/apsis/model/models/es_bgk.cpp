#include <apsis/core/errors.hpp>
#include <apsis/model/correlated_gaussian.hpp>
#include <apsis/model/formulas/ellipsoidal.hpp>
#include <apsis/model/gas_model.hpp>
#include <apsis/model/gas_target.hpp>

#include <algorithm>
#include <cstddef>
#include <functional>

namespace apsis {
namespace {

/// Returns the matrix in the first rows and columns of a larger one.
template <int d>
direction_matrix widened(const scalar::small_matrix<d>& of) {
  direction_matrix same;
  for (int k = 0; k < d; ++k)
    for (int l = 0; l < d; ++l) same.of[k][l] = of.of[k][l];
  return same;
}

/// The ellipsoidal statistical model (Holway, Phys. Fluids 9, 1966) of a monatomic gas: Q = C (G − f) with a
/// Gaussian G. Its covariance is T I + (1 − 1/Pr)(Θ − T I), where Θ is the stress per density. The stress
/// relaxes with the rate C/Pr and the heat flux with C, so that the Prandtl number is Pr.
///
/// In stages with Q̇ the target is G times a quadratic. It is cut off in the tails, where the solution of the
/// stage would be negative, and a polynomial of second degree restores the moments. Rows are reduced as in
/// gas.hpp. Dimensionless.
class es_bgk_model final : public gas_model {
 public:
  explicit es_bgk_model(const model_config& config)
      : gas_model(config, config.parameters.at("prandtl")), formula_{1.0 / config.parameters.at("prandtl")} {
    if (molecules().degrees_of_freedom() != 3)
      throw input_error("model.degrees_of_freedom is not 3 (the model is that of a monatomic gas); give 3");
  }

  /// The H-theorem (Andries et al., Eur. J. Mech. B 19, 2000) holds for Q, but not for stages with Q̇.
  std::optional<convex_entropy> entropy() const override {
    auto of_gas = gas_model::entropy();
    of_gas->collisions_decrease = false;
    return of_gas;
  }

  std::string cut_moment() const override { return "stress"; }

  const scalar::ellipsoidal_model* as_ellipsoidal() const override { return &formula_; }

  int relaxing_count() const override { return pairs() + 1; }

  double moment_accuracy() const override { return target_accuracy; }

  /// s = (Θ_kl − T δ_kl for k ≤ l, weight of Q̇).
  void relaxing_moments(const double* f, const double* omega, double* s) const override {
    std::fill_n(s, relaxing_count(), 0.0);
    const fluid_state state = molecules().state(omega);
    if (!state.admissible()) return;
    const auto stress = compute_stress(molecules(), f, state);
    for (std::size_t k = 0; k < size(); ++k)
      for (std::size_t l = k; l < size(); ++l) *s++ = stress[k][l] - (k == l ? state.T : 0.0);
  }

  void relax(const stage_coefficients& of, double* s) const override {
    const double decay = formula_.decay(of);
    for (int k = 0; k < pairs(); ++k) s[k] *= decay;
    s[pairs()] = formula_.weight_of_derivative(of);
  }

  bool target(const double* omega, const double* s, const double* f, double keep, double* e,
              double& cut) const override {
    const fluid_state state = molecules().state(omega);
    if (!state.admissible()) return molecules().equilibrium(omega, e);
    const auto with_part = [&](double part, double bound, double* row, bool& raised) {
      switch (molecules().dimensions()) {
        case 1:
          return gaussian_target<1>(omega, state, s, part, f, bound, row, raised);
        case 2:
          return gaussian_target<2>(omega, state, s, part, f, bound, row, raised);
        default:
          return gaussian_target<3>(omega, state, s, part, f, bound, row, raised);
      }
    };
    return find_target(omega, s, rate_of_stage(formula_.rate_of_stress, s[pairs()]), keep, e, cut, with_part);
  }

 private:
  std::size_t size() const { return static_cast<std::size_t>(molecules().dimensions()); }
  int pairs() const { return molecules().dimensions() * (molecules().dimensions() + 1) / 2; }

  /// Computes the target in d velocity dimensions, with the deviation of the stress multiplied by `part`.
  template <int d>
  bool gaussian_target(const double* omega, const fluid_state& state, const double* s, double part,
                       const double* f, double keep, double* e, bool& raised) const {
    const gas& g = molecules();
    const auto target =
        scalar::ellipsoidal_target<d>::of(formula_, state, s, s[pairs()], part, g.degrees_of_freedom() - d);
    if (!target.exists) return false;
    const auto fill = [&](double* row) {
      correlated_gaussian(g.grid(), state, widened(target.covariance), widened(target.inverse), row);
      if (g.reduced()) g.fill_h(target.others, row);
    };
    fill(e);
    return conservative_target(g, omega, {e, {}, target.others, std::cref(fill)}, target.shape, f, keep, e,
                               raised);
  }

  scalar::ellipsoidal_model formula_;
};

}  // namespace

extern const model_entry model_es_bgk;
const model_entry model_es_bgk = {
    .name = "es-bgk",
    .description = "f_t + v f_x = C (G[f] - f)/epsilon, a monatomic gas with a Prandtl number",
    .source = "Holway, Phys. Fluids 9 (1966)",
    .has_velocity_grid = true,
    .parameters =
        [] {
          auto all = gas_model::parameters(3.0);
          all.push_back({.name = "prandtl",
                         .value = 2.0 / 3.0,
                         .lowest = 2.0 / 3.0,
                         .highest = 10.0,
                         .doc = "Prandtl number, at least 2/3, for which the Gaussian exists; 2/3 for a "
                                "monatomic gas"});
          return all;
        }(),
    .options = gas_model::texts_with_tails("nonnegative"),
    .make = [](const model_config& config) -> std::unique_ptr<model> {
      return std::make_unique<es_bgk_model>(config);
    }};

}  // namespace apsis
