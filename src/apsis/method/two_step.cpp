#include <apsis/method/two_step.hpp>

#include <apsis/core/embedded.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/method/coefficient.hpp>
#include <apsis/method/method_file.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

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

  /// By the product rule for Q̇ = Q′Q, as in elementary_weights().
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

/// Signs of the form; a failure names the entry.
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

/// flux and last for z → ∞: χ of docs/plateaus.md, with χ_0 = χ_s = 1.
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
  c.band = find_band_of([&](double z) {
    return static_cast<double>(two_step_at_finite_rate(rounded, static_cast<long double>(z)).flux - 1.0L);
  });
  check_claims(m, tolerance, c);
  return c;
}

bool is_two_step_method(const std::string& name) {
  if (is_method_file(name)) return parse_any_method(read_method_text(name), name).steps == 2;
  const auto names = two_step_method_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> two_step_method_names() {
  std::vector<std::string> names;
  for (const auto& file : embedded::two_step_methods()) names.emplace_back(file.name);
  return names;
}

method find_two_step_method(const std::string& name) {
  method found;
  if (is_method_file(name)) {
    found = parse_two_step_method(read_method_text(name), name);
  } else {
    const auto files = embedded::two_step_methods();
    const auto file =
        std::find_if(files.begin(), files.end(), [&](const auto& one) { return one.name == name; });
    if (file == files.end())
      throw input_error("unknown two-step method '" + name.substr(0, 60) + "'; " +
                        suggest(name, two_step_method_names()));
    found = parse_two_step_method(file->text, "two-step-methods/" + name + ".toml");
  }
  const auto c = certify_two_step(found);
  if (!c.claims_hold())
    throw claim_error(fmt::format("two-step method '{}' does not meet its claims: {}", found.name,
                                  fmt::join(c.failures, "; ")));
  return found;
}

}  // namespace apsis
