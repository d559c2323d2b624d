// Methods of two equal steps, files with steps = 2.
#include <apsis/method/kinds/two_step.hpp>

#include <apsis/method/coefficient.hpp>
#include <apsis/method/integrator_kind_registry.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Returns x with x_0 = first and x_i = (Σ_{j<i} ((p_ij + w_ij) x_j + w_ij/r y_j) + r_i start +
/// source_i)/q_i.
template <class Real>
std::vector<Real> solve_rows(const shu_osher_form<Real>& m, const Real& first, const Real& start,
                             const std::vector<Real>& y, const std::vector<Real>& source,
                             const std::vector<Real>& q) {
  const auto initial = initial_weights(m);
  std::vector<Real> x(m.stages());
  x[0] = first;
  for (std::size_t i = 1; i < x.size(); ++i) {
    Real sum = initial[i] * start + source[i];
    for (std::size_t j = 0; j < i; ++j) sum += (m.P(i, j) + m.W(i, j)) * x[j] + m.W(i, j) / m.r * y[j];
    x[i] = sum / q[i];
  }
  return x;
}

template <class Real>
class weights_of_trees {
 public:
  weights_of_trees(const shu_osher_form<Real>& m, const std::vector<rooted_tree>& trees)
      : m_(m), trees_(trees), zeros_(m.stages(), Real(0)), ones_(m.stages(), Real(1)) {}

  std::vector<Real> run() {
    std::vector<Real> last;
    for (const auto& tree : trees_) {
      const Real first = Real(tree.order % 2 == 0 ? 1 : -1) / Real(tree.density);
      const auto g = product(tree.children, none);
      if (tree.root == colour::F) {
        phi_.push_back(solve_rows(m_, first, Real(0), g, zeros_, ones_));
      } else {
        const auto h = merged(tree);
        auto source = zeros_;
        for (std::size_t i = 0; i < source.size(); ++i) source[i] = m_.D(i, i) * g[i] + m_.ddot[i] * h[i];
        phi_.push_back(solve_rows(m_, first, Real(0), zeros_, source, ones_));
      }
      last.push_back(phi_.back().back());
    }
    return last;
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  std::vector<Real> product(const std::vector<int>& factors, std::size_t left_out) const {
    auto all = ones_;
    for (std::size_t f = 0; f < factors.size(); ++f)
      for (std::size_t i = 0; i < all.size() && f != left_out; ++i)
        all[i] *= phi_[static_cast<std::size_t>(factors[f])][i];
    return all;
  }

  /// Returns the factors of ḋ, by the product rule for Q̇ = Q′Q as in elementary_weights().
  std::vector<Real> merged(const rooted_tree& tree) const {
    auto sum = zeros_;
    for (std::size_t k = 0; k < tree.children.size(); ++k) {
      const auto& child = trees_[static_cast<std::size_t>(tree.children[k])];
      if (child.root != colour::G) continue;
      const auto others = product(tree.children, k), grandchildren = product(child.children, none);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += others[i] * grandchildren[i];
    }
    return sum;
  }

  const shu_osher_form<Real>& m_;
  const std::vector<rooted_tree>& trees_;
  std::vector<Real> zeros_, ones_;
  std::vector<std::vector<Real>> phi_;
};

void find_order(const shu_osher_form<mp_real>& form, const mp_real& tolerance, two_step_certificate& c) {
  constexpr int highest = 6;
  for (int p = 1; p <= highest && c.order == p - 1; ++p) {
    const auto trees = rooted_trees(p, tree_colours::both);
    const auto weights = two_step_weights(form, trees);
    mp_real largest(0), squares(0);
    for (std::size_t k = 0; k < trees.size(); ++k) {
      const mp_real residual = abs(weights[k] - mp_real(1) / mp_real(trees[k].density));
      if (trees[k].order == p) squares += residual * residual;
      largest = std::max(largest, residual);
    }
    c.error_constant = sqrt(squares) / (1 + weight_of_previous(form));
    if (!(largest <= tolerance)) return;
    c.order = p;
    c.order_residual = largest;
    c.conditions = static_cast<int>(trees.size());
  }
}

/// Checks the signs of the form, and counts evaluations and solves. A failure names the entry.
void check_signs(const shu_osher_form<mp_real>& form, const mp_real& tolerance, two_step_certificate& c) {
  const auto initial = initial_weights(form);
  const auto check = [&c](const std::string& what, const mp_real& value, const mp_real& least) {
    if (value < least)
      c.failures.push_back(
          fmt::format("{} = {} is negative: the form is not convex", what, short_text(value)));
  };
  c.type_a = true;
  for (std::size_t i = 1; i < form.stages(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      check(fmt::format("P_{},{}", i + 1, j + 1), form.P(i, j), 0);
      check(fmt::format("W_{},{}", i + 1, j + 1), form.W(i, j), 0);
    }
    check(fmt::format("the weight of u^n in row {}", i + 1), initial[i], -tolerance);
    check(fmt::format("d_{}", i + 1), form.D(i, i), 0);
    check(fmt::format("-ddot_{}", i + 1), -form.ddot[i], 0);
    const bool relaxes = form.D(i, i) != 0 || form.ddot[i] != 0;
    c.type_a = c.type_a && relaxes;
    c.implicit_solves += relaxes ? 1 : 0;
  }
  c.ssp_coefficient = c.failures.empty() ? form.r : mp_real(0);
  for (std::size_t j = 0; j < form.stages(); ++j)
    for (std::size_t i = j + 1; i < form.stages(); ++i)
      if (form.W(i, j) != 0) {
        ++c.explicit_evaluations;
        break;
      }
}

/// Checks flux and last for z → ∞, with χ of docs/plateaus.md and χ_0 = χ_s = 1.
void find_slow_terms(const shu_osher_form<mp_real>& form, const mp_real& tolerance, two_step_certificate& c) {
  const std::size_t rows = form.stages();
  std::vector<mp_real> kept(rows), zeros(rows), ones(rows, mp_real(1));
  kept[0] = 1;
  for (std::size_t i = 1; i < rows; ++i) {
    if (form.ddot[i] != 0 || form.D(i, i) == 0) continue;
    mp_real sum(0);
    for (std::size_t j = 0; j < i; ++j) sum += form.W(i, j);
    kept[i] = sum / (form.r * form.D(i, i));
  }
  const mp_real flux = solve_rows(form, mp_real(-1), mp_real(0), kept, zeros, ones).back();
  c.keeps_slow_terms = c.type_a && abs(kept.back() - 1) <= tolerance && abs(flux - 1) <= tolerance;
}

void check_claims(const method& m, const mp_real& tolerance, two_step_certificate& c) {
  if (c.order != m.claims.order)
    c.failures.push_back(fmt::format("the order is {} instead of {}", c.order, m.claims.order));
  if (m.claims.ssp_coefficient && c.ssp_coefficient != coefficient_value(*m.claims.ssp_coefficient))
    c.failures.push_back(fmt::format("the SSP coefficient of the form is {} instead of {}",
                                     short_text(c.ssp_coefficient), *m.claims.ssp_coefficient));
  if (m.claims.type && (*m.claims.type != "A" || !c.type_a))
    c.failures.push_back(fmt::format("the type is not {}", *m.claims.type));
  if (m.claims.intermediate && (*m.claims.intermediate != "slow" || !c.keeps_slow_terms))
    c.failures.push_back("the terms of size epsilon are not those claimed");
  if (!(abs(c.root) < 1 - tolerance)) c.failures.push_back("the second root has modulus 1: not zero-stable");
}

}  // namespace

template <class Real>
std::vector<Real> two_step_weights(const shu_osher_form<Real>& m, const std::vector<rooted_tree>& trees) {
  return weights_of_trees<Real>(m, trees).run();
}

template <class Real>
two_step_rate<Real> two_step_at_finite_rate(const shu_osher_form<Real>& m, const Real& z) {
  const std::size_t rows = m.stages();
  const std::vector<Real> zeros(rows, Real(0)), ones(rows, Real(1));
  std::vector<Real> q, moved_by;
  for (std::size_t i = 0; i < rows; ++i) q.push_back(Real(1) + z * (m.D(i, i) - z * m.ddot[i]));
  const std::vector<Real> rates(rows, z);  // −ζ w_ij/r with ζ = −z
  const auto moved = solve_rows(m, Real(0), Real(0), rates, zeros, q);
  const auto start = solve_rows(m, Real(1), Real(1), zeros, zeros, q);
  two_step_rate<Real> out;
  out.last = moved.back() / (Real(1) - start.back());
  std::vector<Real> kept(rows);
  for (std::size_t i = 0; i < rows; ++i) kept[i] = moved[i] + out.last * start[i];
  out.flux = solve_rows(m, Real(0), Real(0), kept, zeros, ones).back() / (Real(1) + weight_of_previous(m));
  return out;
}

template <class Real>
Real weight_of_previous(const shu_osher_form<Real>& m) {
  const std::vector<Real> zeros(m.stages(), Real(0)), ones(m.stages(), Real(1));
  return solve_rows(m, Real(1), Real(0), zeros, zeros, ones).back();
}

template std::vector<double> two_step_weights(const shu_osher_form<double>&, const std::vector<rooted_tree>&);
template std::vector<mp_real> two_step_weights(const shu_osher_form<mp_real>&,
                                               const std::vector<rooted_tree>&);
template two_step_rate<double> two_step_at_finite_rate(const shu_osher_form<double>&, const double&);
template two_step_rate<long double> two_step_at_finite_rate(const shu_osher_form<long double>&,
                                                            const long double&);
template double weight_of_previous(const shu_osher_form<double>&);
template long double weight_of_previous(const shu_osher_form<long double>&);
template mp_real weight_of_previous(const shu_osher_form<mp_real>&);

two_step_certificate certify_two_step(const method& m) {
  const auto form = m.coefficients<mp_real>();
  const mp_real tolerance = residual_tolerance(m.precision());
  two_step_certificate c;
  c.name = m.name;
  check_signs(form, tolerance, c);
  find_order(form, tolerance, c);
  find_slow_terms(form, tolerance, c);
  c.root = -weight_of_previous(form);
  const auto rounded = m.coefficients<long double>();
  c.band = compute_band_of([&](double z) {
    return static_cast<double>(two_step_at_finite_rate(rounded, static_cast<long double>(z)).flux - 1.0L);
  });
  check_claims(m, tolerance, c);
  return c;
}

namespace two_step_kind {
namespace {

/// A two-step method as an integrator, the rows of a file with steps = 2.
class two_step_integrator final : public time_integrator {
 public:
  /// Copies the method; its claims are not checked.
  explicit two_step_integrator(method m);
  /// md-imex-10-3-mixed up to order 4, extrapolated Euler above.
  const method& starter() const override { return *starter_; }
  const method* file() const override { return &rows_; }
  amplification growth() const override { return amplification(rows_); }
  /// The error of the layer is that of the starter.
  rate_errors errors_at(double z) const override;
  integrator_certificate certify() const override;

 private:
  method rows_;
  const method* starter_;
};

two_step_integrator::two_step_integrator(method m) : rows_(std::move(m)) {
  name = rows_.name;
  title = rows_.title;
  kind = "two-step";
  order = rows_.claims.order;
  steps = 2;
  form = rows_.coefficients<double>();
  stages = rows_.stages() - 1;
  kept_states = static_cast<int>(rows_.stages());
  needs.equal_steps = true;
  // The first steps may be of one order less. md-imex-10-3-mixed has the right terms of size epsilon and is
  // SSP up to r = 1.25. The starters of higher order are not SSP.
  const bool has_ssp_starter = order <= 4;
  starter_ =
      &find_method(has_ssp_starter ? "md-imex-10-3-mixed" : fmt::format("extrapolated-euler-{}", order));
  if (has_ssp_starter) ssp_coefficient = std::min(form.r, starter_->coefficients<double>().r);
  const double previous = weight_of_previous(form);
  weights = {1.0 - previous, previous};
}

rate_errors two_step_integrator::errors_at(double z) const {
  const auto at = two_step_at_finite_rate(form, z);
  return {at.flux - 1.0, at.last - 1.0, rate_errors_at(*starter_, z).layer};
}

integrator_certificate two_step_integrator::certify() const {
  const auto c = certify_two_step(rows_);
  const auto number = [](const mp_real& x) { return x.convert_to<double>(); };
  integrator_certificate out;
  out.failures = c.failures;
  out.facts = {{"origin", rows_.origin},
               {"purpose", rows_.purpose},
               {"kind", to_string(rows_.kind)},
               {"steps", steps},
               {"order", c.order},
               {"order_residual", number(c.order_residual)},
               {"error_constant", number(c.error_constant)},
               {"ssp_coefficient", number(c.ssp_coefficient)},
               {"cfl_limits", {}},
               {"second_root", number(c.root)},
               {"type", c.type_a ? "A" : "none"},
               {"stages", static_cast<int>(stages)},
               {"explicit_evaluations", c.explicit_evaluations},
               {"implicit_solves", c.implicit_solves},
               {"buffers", kept_states + 1},  // rows, among them u^{n−1}, and u^n
               {"r_per_evaluation", number(c.ssp_coefficient) / c.explicit_evaluations},
               {"intermediate_regime.keeps", c.keeps_slow_terms ? "slow" : "none"},
               {"intermediate_regime.band.error", c.band.error},
               {"intermediate_regime.band.at", c.band.at}};
  out.lines = {{"steps", "2, of equal length (time.dt or time.cfl)"},
               {"order", fmt::format("{} ({} conditions, residual {:.1e}), error constant {:.4g}", c.order,
                                     c.conditions, number(c.order_residual), number(c.error_constant))},
               {"SSP coefficient r", fmt::format("{:.15g} of the form", number(c.ssp_coefficient))},
               {"linear stability", {}},
               {"second root", fmt::format("{:.4g} (zero-stable if below 1 in modulus)", number(c.root))},
               {"type", c.type_a ? "A: asymptotic preserving" : "none"},
               {"cost per step", fmt::format("{} transport evaluations, {} implicit solves",
                                             c.explicit_evaluations, c.implicit_solves)},
               {"terms of size epsilon",
                c.keeps_slow_terms ? "exact for data near equilibrium (N1, N2)" : "not exact"},
               {"where epsilon ~ dt",
                fmt::format("error of the O(epsilon) term at most {:.3g} dt, at epsilon/C = dt/{:.3g}",
                            c.band.error, c.band.at)}};
  return out;
}

bool reads(const method& file) {
  return file.steps == 2;
}

std::unique_ptr<time_integrator> make(method file) {
  return std::make_unique<two_step_integrator>(std::move(file));
}

}  // namespace
}  // namespace two_step_kind

extern const integrator_kind_entry integrator_kind_two_step;
const integrator_kind_entry integrator_kind_two_step = {
    .name = "two-step",
    .description = "stages that also start from u^(n-1) and its transport",
    .reads = two_step_kind::reads,
    .of_file = two_step_kind::make};

}  // namespace apsis
