// IMEX backward differentiation formulas of order 1 to 5, "imex-bdf-k".
#include <apsis/method/kinds/imex_bdf.hpp>

#include <apsis/method/integrator_kind_registry.hpp>

#include <fmt/format.h>

namespace apsis {
namespace imex_bdf_kind {
namespace {

const std::string prefix = "imex-bdf-";
constexpr int highest = 5;

/// The rows u^{n−k+1} … u^{n−1} and u^{n+1}, without transport.
shu_osher_form<double> rows_of(const linear_formula<double>& m) {
  const auto earlier = m.a.size() - 1, rows = earlier + 1;
  shu_osher_form<double> form{matrix<double>(rows, rows), matrix<double>(rows, rows),
                              matrix<double>(rows, rows), std::vector<double>(rows), 1.0};
  for (std::size_t j = 0; j < earlier; ++j) form.P(earlier, j) = m.a[earlier - j];
  form.D(earlier, earlier) = m.b;
  return form;
}

/// IMEX-BDF of order k as an integrator, "imex-bdf-k". Its form has no transport: T(u^n) enters, but no row
/// stands for u^n.
class imex_bdf_integrator final : public time_integrator {
 public:
  /// Throws input_error unless 1 ≤ k ≤ 5.
  explicit imex_bdf_integrator(int k);
  /// Extrapolated Euler of order k, certified.
  const method& starter() const override { return *starter_; }
  amplification growth() const override;
  /// The errors are 0, except that of the layer: the starter integrates it.
  rate_errors errors_at(double z) const override;
  integrator_certificate certify() const override;

 private:
  const method* starter_;
};

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (int k = 1; k <= highest; ++k) all.push_back(prefix + std::to_string(k));
  return all;
}

std::unique_ptr<time_integrator> make(const std::string& name) {
  return std::make_unique<imex_bdf_integrator>(std::stoi(name.substr(prefix.size())));
}

imex_bdf_integrator::imex_bdf_integrator(int k) {
  const auto formula = imex_bdf_coefficients<double>(k);
  name = prefix + std::to_string(k);
  title = fmt::format("IMEX backward differentiation formula of order {}", k);
  kind = "imex-bdf";
  order = steps = kept_states = k;
  needs.equal_steps = true;
  if (k == 1) ssp_coefficient = 1.0;  // implicit-explicit Euler; others have negative weights
  weights = formula.a;
  form = rows_of(formula);
  starter_ = &find_method(k == 1 ? "forward-backward-euler" : fmt::format("extrapolated-euler-{}", k));
}

amplification imex_bdf_integrator::growth() const {
  return amplification(imex_bdf_coefficients<double>(steps));
}

rate_errors imex_bdf_integrator::errors_at(double z) const {
  rate_errors errors = rate_errors_at(*starter_, z);
  errors.flux = errors.last = 0.0;
  return errors;
}

integrator_certificate imex_bdf_integrator::certify() const {
  const auto found = compute_formula_orders(imex_bdf_coefficients<mp_real>(steps));
  const auto number = [](const mp_real& x) { return x.convert_to<double>(); };
  const double of_q = number(found.implicit_constant), of_t = number(found.explicit_constant),
               amplified = error_amplification(weights);
  integrator_certificate c;
  if (found.order != order)
    c.failures.push_back(fmt::format("the order is {} instead of {}", found.order, order));
  c.facts = {{"kind", "imex"},
             {"steps", steps},
             {"starter", starter_->name},
             {"order", found.order},
             {"order_residual", number(found.residual)},
             {"error_constant_of_collisions", of_q},
             {"error_constant_of_transport", of_t},
             {"ssp_coefficient", ssp_coefficient},
             {"cfl_limits", {}},
             {"error_amplification", amplified},
             {"explicit_evaluations", 1},
             {"implicit_solves", 1},
             {"buffers", {}}};
  c.lines = {
      {"steps", fmt::format("{}, of equal length (time.dt or time.cfl); the first ones by '{}'", steps,
                            starter_->name)},
      {"order", fmt::format("{} (residual {:.1e}), error constants {:.4g} of Q and {:.4g} of T", found.order,
                            number(found.residual), of_q, of_t)},
      {"SSP coefficient r", ssp_coefficient > 0.0 ? fmt::format("{:g}", ssp_coefficient)
                                                  : "none: some weights of earlier values are negative"},
      {"linear stability", {}},
      {"error amplification",
       fmt::format("errors of at most 1 in every step change u by at most {:.3g} in one", amplified)},
      {"cost per step", "1 transport evaluation, 1 implicit solve"}};
  return c;
}

}  // namespace
}  // namespace imex_bdf_kind

extern const integrator_kind_entry integrator_kind_imex_bdf;
const integrator_kind_entry integrator_kind_imex_bdf = {
    .name = "imex-bdf",
    .description = "backward differentiation with extrapolated T: one stage from k values before it",
    .formulas = imex_bdf_kind::names,
    .of_formula = imex_bdf_kind::make};

}  // namespace apsis
