// IMEX general linear methods of order 2 and 3, "imex-dimsim-p".
#include <apsis/method/kinds/imex_dimsim.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/method/integrator_kind_registry.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace imex_dimsim_kind {
namespace {

const std::string prefix = "imex-dimsim-";
constexpr int lowest = 2, highest = 3;

void set_second_order(multistage_formula<mp_real>& m) {
  const mp_real root = sqrt(mp_real(2));
  m.c = {0, 1};
  m.v = {(3 - root) / 2, (root - 1) / 2};
  m.A(0, 0) = (2 - root) / 2;
  m.A(1, 0) = (6 + 2 * root) / 7;
  m.A_hat(1, 0) = mp_real(15) / 8;
}

/// The decimals are the root of the conditions that M(z) has one eigenvalue that is not 0 (Runge–Kutta
/// stability), found by Newton's method with 60 digits. λ solves λ³ − 3λ² + 3λ/2 = 1/6.
void set_third_order(multistage_formula<mp_real>& m) {
  m.c = {0, mp_real(1) / 2, 1};
  m.v = {mp_real("0.552090962040338484831912371866590385869236390"),
         mp_real("0.734856659871291988619127217965995448942705967")};
  m.v.push_back(1 - m.v[0] - m.v[1]);
  m.A(0, 0) = mp_real("0.435866521508458999416019451193556842529294093");
  m.A(1, 0) = mp_real("0.250514880897719281691272917975237542134169910");
  m.A(2, 0) = mp_real("-1.211594287777005633927190056140766607119049410");
  m.A(2, 1) = mp_real("1.001274599881185558395604100540463557669584450");
  m.A_hat(1, 0) = mp_real(7) / 8;
  m.A_hat(2, 0) = mp_real(-9) / 20;
  m.A_hat(2, 1) = mp_real(23) / 20;
}

/// Returns the rows of a step for bounds of rounding: the p earlier values, the explicit part R_i and the
/// solution U_i of every stage, where Δt Q(U_i) = (U_i − R_i)/λ, and the handed-on value with the largest
/// weights. Transport is left out.
shu_osher_form<double> rows_of(const multistage_formula<double>& m) {
  const std::size_t s = m.stages(), rows = 3 * s + 1;
  const auto start = compute_starting_weights(m);
  shu_osher_form<double> form{matrix<double>(rows, rows), matrix<double>(rows, rows),
                              matrix<double>(rows, rows), std::vector<double>(rows), 1.0};
  const auto add_values = [&](std::size_t row, std::size_t i, double weight) {
    for (std::size_t l = 1; l <= s; ++l) form.P(row, s - l) += weight * start.alpha(i, l);
  };
  const auto add_collision = [&](std::size_t row, std::size_t j, double weight) {
    form.P(row, s + 2 * j) -= weight / m.lambda();
    form.P(row, s + 2 * j + 1) += weight / m.lambda();
  };
  for (std::size_t i = 0; i < s; ++i) {
    const std::size_t sum = s + 2 * i, solution = sum + 1;
    add_values(sum, i, 1.0);
    for (std::size_t j = 0; j < i; ++j) add_collision(sum, j, m.A(i, j));
    form.P(solution, sum) = 1.0;
    form.D(solution, solution) = m.lambda();
  }
  const auto largest = [&m, s](std::size_t i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < s; ++j) sum += std::abs(m.B(i, j));
    return sum;
  };
  std::size_t worst = 0;
  for (std::size_t i = 1; i < s; ++i)
    if (largest(i) > largest(worst)) worst = i;
  for (std::size_t j = 0; j < s; ++j) {
    add_values(rows - 1, j, m.v[j]);
    add_collision(rows - 1, j, m.B(worst, j));
  }
  return form;
}

class imex_dimsim_integrator final : public time_integrator {
 public:
  /// Throws input_error unless there are coefficients of order p.
  explicit imex_dimsim_integrator(int p);
  /// Extrapolated Euler of order p, certified.
  const method& starter() const override { return *starter_; }
  amplification growth() const override;
  /// The errors are 0, except that of the layer: the starter integrates it. Where T is constant, stages have
  /// the constant deviation εT/C, because both parts have the same stage order.
  rate_errors errors_at(double z) const override;
  integrator_certificate certify() const override;

 private:
  multistage_formula<mp_real> formula_;
  const method* starter_;
};

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (int p = lowest; p <= highest; ++p) all.push_back(prefix + std::to_string(p));
  return all;
}

std::unique_ptr<time_integrator> make(const std::string& name) {
  return std::make_unique<imex_dimsim_integrator>(std::stoi(name.substr(prefix.size())));
}

imex_dimsim_integrator::imex_dimsim_integrator(int p) : formula_(imex_dimsim_coefficients(p)) {
  name = prefix + std::to_string(p);
  title = fmt::format("IMEX general linear method of order and stage order {} (DIMSIM)", p);
  kind = "imex-dimsim";
  order = p;
  stages = static_cast<std::size_t>(p);
  steps = p + 1;  // the first handed-on values need p + 1 values; later ones replace them
  kept_states = 2 * p;
  needs.equal_steps = true;
  weights.assign(static_cast<std::size_t>(steps), 0.0);
  weights.front() = 1.0;
  form = rows_of(formula_.in<double>());
  starter_ = &find_method(fmt::format("extrapolated-euler-{}", p));
}

amplification imex_dimsim_integrator::growth() const {
  return amplification(formula_.in<double>());
}

rate_errors imex_dimsim_integrator::errors_at(double z) const {
  rate_errors errors = rate_errors_at(*starter_, z);
  errors.flux = errors.last = 0.0;
  return errors;
}

integrator_certificate imex_dimsim_integrator::certify() const {
  const auto found = compute_multistage_orders(formula_);
  const auto number = [](const mp_real& x) { return x.convert_to<double>(); };
  const double of_q = number(found.implicit_constant), of_t = number(found.explicit_constant);
  integrator_certificate c;
  if (found.order != order)
    c.failures.push_back(fmt::format("the order is {} instead of {}", found.order, order));
  c.facts = {{"kind", "imex"},
             {"steps", steps},
             {"stages", order},
             {"starter", starter_->name},
             {"order", found.order},
             {"stage_order", found.order},
             {"order_residual", number(found.residual)},
             {"error_constant_of_collisions", of_q},
             {"error_constant_of_transport", of_t},
             {"ssp_coefficient", ssp_coefficient},
             {"cfl_limits", {}},
             {"explicit_evaluations", order},
             {"implicit_solves", order},
             {"buffers", {}}};
  c.lines = {
      {"steps", fmt::format("{} values at the start, of steps of equal length (time.dt or time.cfl) by '{}'",
                            steps, starter_->name)},
      {"order",
       fmt::format("{}, also of the stages (residual {:.1e}), error constants {:.4g} of Q and {:.4g} "
                   "of T",
                   found.order, number(found.residual), of_q, of_t)},
      {"SSP coefficient r", "none: some weights are negative"},
      {"linear stability", {}},
      {"cost per step", fmt::format("{0} transport evaluations, {0} implicit solves", order)}};
  return c;
}

}  // namespace
}  // namespace imex_dimsim_kind

multistage_formula<mp_real> imex_dimsim_coefficients(int p) {
  using namespace imex_dimsim_kind;
  if (p < lowest || p > highest)
    throw input_error(
        fmt::format("there is no IMEX-DIMSIM of order {} (its orders are {} and {}); choose one of "
                    "these",
                    p, lowest, highest));
  const auto s = static_cast<std::size_t>(p);
  multistage_formula<mp_real> m;
  m.A = m.A_hat = matrix<mp_real>(s, s);
  if (p == 2)
    set_second_order(m);
  else
    set_third_order(m);
  for (std::size_t i = 1; i < s; ++i) m.A(i, i) = m.A(0, 0);
  m.B = new_value_coefficients(m.c, m.v, m.A);
  m.B_hat = new_value_coefficients(m.c, m.v, m.A_hat);
  return m;
}

extern const integrator_kind_entry integrator_kind_imex_dimsim;
const integrator_kind_entry integrator_kind_imex_dimsim = {
    .name = "imex-dimsim",
    .description = "general linear: stages and values that both have the full order",
    .formulas = imex_dimsim_kind::names,
    .of_formula = imex_dimsim_kind::make};

}  // namespace apsis
