#include <apsis/method/certificate.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/method/claim_checks.hpp>
#include <apsis/method/coefficient.hpp>
#include <apsis/method/convexity.hpp>
#include <apsis/method/monotonicity.hpp>
#include <apsis/method/order_conditions.hpp>
#include <apsis/method/resolved_flows.hpp>
#include <apsis/method/stability.hpp>

#include <algorithm>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

/// Returns the Butcher form to which the order conditions of a method apply.
butcher_form<mp_real> conditioned_form(const shu_osher_form<mp_real>& form, method_kind kind) {
  return to_butcher(solves_exactly(kind) ? with_resolved_flows(form) : form);
}

/// Returns the largest order whose conditions are evaluated. Order 9 has 286 trees of one colour, but 89 894
/// of two.
int last_order(method_kind kind) {
  if (solves_exactly(kind)) return order_of_resolved_flows;
  return certificate::highest_order + (kind == method_kind::imex ? 0 : 1);
}

/// Order conditions of a result: that of the method or its embedded solution.
struct conditions_of_result {
  order_levels<mp_real>& levels;
  std::size_t result;

  const std::vector<rooted_tree>& trees(int order) const { return levels.at(order).trees; }
  const std::vector<mp_real>& weights(int order) const { return levels.at(order).weights[result]; }
};

/// Finds the order of a result, and the conditions of the next order that it violates.
void find_order(const conditions_of_result& of, const mp_real& tolerance, certificate& c) {
  const int last = last_order(c.kind);
  mp_real largest(0);
  int conditions = 0;
  for (int p = 1; p <= last && c.order == p - 1; ++p) {
    const auto& trees = of.trees(p);
    const auto& weights = of.weights(p);
    mp_real squares(0);
    c.next.clear();
    for (std::size_t k = 0; k < trees.size(); ++k) {
      const mp_real wanted = mp_real(1) / mp_real(trees[k].density);
      const mp_real residual = abs(weights[k] - wanted);
      squares += residual * residual;
      ++conditions;
      if (!(residual <= tolerance)) {
        c.next.push_back({trees[k].name, p, weights[k], wanted});
      } else if (residual > largest) {
        largest = residual;
      }
    }
    if (!c.next.empty() || p > certificate::highest_order) {
      c.error_constant = sqrt(squares);
      return;
    }
    c.order = p;
    c.order_residual = largest;
    c.conditions = conditions;
  }
  c.error_constant = std::numeric_limits<double>::quiet_NaN();
}

/// Exact collisions do not limit the step.
void find_ssp_of_exact_collisions(const shu_osher_form<mp_real>& form, const butcher_form<mp_real>& b,
                                  const mp_real& zero, certificate& c) {
  c.unconditional = is_convex(form, c.kind, form.stages());
  const mp_real largest = largest_step_of_form(form);
  c.bounded = !c.unconditional || largest > 0;
  c.ssp_coefficient = c.unconditional ? largest : mp_real(0);
  c.explicit_radius = monotonicity_radius(b.A_hat, zero, c.ssp_coefficient);
}

bool any_in_column(const matrix<mp_real>& m, std::size_t j) {
  for (std::size_t i = 0; i < m.rows(); ++i)
    if (m(i, j) != 0) return true;
  return false;
}

void find_ssp(const butcher_form<mp_real>& b, const mp_real& zero, certificate& c) {
  if (c.kind == method_kind::explicit_only) {
    c.ssp_coefficient = c.explicit_radius = monotonicity_radius(b.A_hat, zero);
    return;
  }
  const auto analysis = analyse_imex(b, zero);
  c.unconditional = analysis.unconditional;
  c.bounded = analysis.bounded;
  c.ssp_coefficient = analysis.exists ? analysis.coefficient : mp_real(0);
  c.limiting_entry = analysis.forbids;
  // r is a lower bound of the radius of the explicit part, and often equal to it.
  if (c.kind == method_kind::imex) c.explicit_radius = monotonicity_radius(b.A_hat, zero, c.ssp_coefficient);
  bool derivatives = false;
  for (std::size_t j = 0; j < b.stages(); ++j) derivatives = derivatives || any_in_column(b.A_dot, j);
  if (c.kind == method_kind::implicit_only && !analysis.exists && !derivatives)
    c.radius_of_implicit_part = monotonicity_radius(b.A, zero);
}

void find_structure(const method& m, const shu_osher_form<mp_real>& form, const butcher_form<mp_real>& b,
                    certificate& c) {
  c.gsa = !m.ends_with_update();
  bool all_implicit = true, later_implicit = true;
  for (std::size_t i = 0; i < form.stages(); ++i) {
    c.explicit_evaluations += any_in_column(b.A_hat, i) ? 1 : 0;
    if (!c.gsa && i + 1 == form.stages()) break;  // the update is not a stage
    const bool implicit = c.kind != method_kind::explicit_only && (form.D(i, i) != 0 || form.ddot[i] != 0);
    c.implicit_solves += implicit ? 1 : 0;
    all_implicit = all_implicit && implicit;
    later_implicit = later_implicit && (implicit || i == 0);
  }
  if (c.kind == method_kind::explicit_only) {
    c.type = "explicit";
  } else if (all_implicit) {
    c.type = "A";
  } else if (later_implicit) {
    c.type = any_in_column(b.A, 0) || any_in_column(b.A_dot, 0) ? "CK" : "ARS";
  } else {
    c.type = "none";
  }
  c.ap = c.type == "A" && c.gsa;
  c.ap_data = c.type == "A" ? "any data" : (c.type == "ARS" || c.type == "CK") ? "consistent data" : "none";
  if (!c.gsa && c.ap_data != "none") c.ap_data += " (moments only)";
}

void find_intermediate_regime(const shu_osher_form<mp_real>& form, const mp_real& tolerance, certificate& c) {
  c.regime = analyse_intermediate_regime(form);
  if (!c.regime.applies) return;
  const auto is_one = [&](const mp_real& x) { return abs(x - 1) <= tolerance; };
  c.keeps_slow_terms = is_one(c.regime.flux) && is_one(c.regime.last);
  c.keeps_layer = is_one(c.regime.layer);
}

/// Returns |cosine| of the angle between the residuals of order p and 1/γ.
mp_real alignment_of(const conditions_of_result& of, int p) {
  const auto& trees = of.trees(p);
  const auto& weights = of.weights(p);
  mp_real along(0), residuals(0), exact(0);
  for (std::size_t k = 0; k < trees.size(); ++k) {
    const mp_real wanted = mp_real(1) / mp_real(trees[k].density);
    along += (weights[k] - wanted) * wanted;
    residuals += (weights[k] - wanted) * (weights[k] - wanted);
    exact += wanted * wanted;
  }
  return residuals == 0 ? mp_real(0) : mp_real(abs(along) / sqrt(residuals * exact));
}

/// Checks that ũ is a stage that can be solved and, if its row is `convex`, that it preserves what the stages
/// preserve.
void check_embedded_signs(const shu_osher_form<mp_real>& form, const mp_real& tolerance, bool convex,
                          certificate& c) {
  const std::size_t last = form.stages() - 1;
  const auto check = [&](const std::string& what, const mp_real& value, const mp_real& least) {
    if (value < least)
      c.failures.push_back(
          fmt::format("{} = {} is negative: the embedded solution is not convex", what, short_text(value)));
  };
  for (std::size_t j = 0; convex && j < last; ++j) {
    check(fmt::format("embedded.P_{}", j + 1), form.P(last, j), 0);
    check(fmt::format("embedded.W_{}", j + 1), form.W(last, j), 0);
  }
  if (convex) check("the weight of u^n in [embedded]", initial_weights(form)[last], -tolerance);
  if (c.kind == method_kind::explicit_only) return;
  check("embedded.d", form.D(last, last), 0);
  check("-embedded.ddot", -form.ddot[last], 0);
}

/// Returns embedded_certificate::weight.
double weight_of_estimate(const embedded_certificate& e, const certificate& c) {
  constexpr double usual = 18.0;  // keeps errors within 30 tolerances (docs/methods.md)
  const mp_real alignment = std::max(e.alignment, mp_real("0.1"));
  const double ratio = mp_real(c.error_constant / (alignment * e.estimate)).convert_to<double>();
  return e.order == c.order - 1 && ratio > usual ? ratio / usual : 1.0;
}

/// Returns the number of decimals to which the order of ũ can be checked: the smaller of those of the method
/// and of its embedded row.
int precision_of(const method& extended, const embedded_row& row) {
  int own = std::max(decimals(row.d), decimals(row.ddot));
  for (const auto* weights : {&row.P, &row.W})
    for (const auto& weight : *weights) own = std::max(own, decimals(weight));
  return own > 0 ? std::min(own, extended.precision()) : extended.precision();
}

/// Requires an embedded row; `extended` has it as a further row.
void find_embedded_solution(const method& m, const method& extended, const conditions_of_result& conditions,
                            certificate& c) {
  const auto form = extended.coefficients<mp_real>();
  const mp_real tolerance = residual_tolerance(precision_of(extended, *m.embedded));
  certificate row;
  row.kind = m.kind;
  find_order(conditions, tolerance, row);
  embedded_certificate e;
  e.order = row.order;
  e.conditions = row.conditions;
  e.order_residual = row.order_residual;
  e.estimate = row.error_constant;
  e.alignment = alignment_of(conditions, row.order + 1);
  e.relaxes = m.kind != method_kind::explicit_only && !extended.ends_with_update();
  e.implicit_solves = e.relaxes ? 1 : 0;
  if (m.kind == method_kind::imex && e.relaxes)
    if (const auto terms = analyse_intermediate_regime(form); terms.applies) e.last = terms.last;
  const std::size_t s = m.stages();
  for (std::size_t j = 0; j < s; ++j) {
    bool evaluated = false;
    for (std::size_t i = 0; i < s; ++i) evaluated = evaluated || form.W(i, j) != 0;
    e.explicit_evaluations += form.W(s, j) != 0 && !evaluated ? 1 : 0;
  }
  e.weight = weight_of_estimate(e, c);
  c.embedded = e;
  if (m.embedded->order >= m.claims.order)
    c.failures.push_back(
        fmt::format("embedded.order = {} is not below the order {} of the method, so that the error could "
                    "not be estimated",
                    m.embedded->order, m.claims.order));
  if (e.order > m.embedded->order) {
    c.failures.push_back(fmt::format("embedded.order = {} but the embedded solution has order {}",
                                     m.embedded->order, e.order));
  } else {
    check_order_claim(extended, row);
    for (const auto& failure : row.failures) c.failures.push_back("[embedded] " + failure);
  }
  check_embedded_signs(form, tolerance, m.embedded->convex, c);
}

}  // namespace

certificate certify(const method& m, certificate_scope scope) {
  certificate c;
  c.name = m.name;
  c.kind = m.kind;
  const auto form = m.coefficients<mp_real>();
  const auto b = to_butcher(form);
  const mp_real tolerance = residual_tolerance(m.precision());
  // Both results of a method with an embedded row have the same stages, and are evaluated together.
  std::optional<method> extended;
  if (m.embedded) extended = m.with_embedded_row();
  const bool together = extended && !solves_exactly(m.kind);
  order_levels<mp_real> levels(
      together ? to_butcher(extended->coefficients<mp_real>()) : conditioned_form(form, m.kind),
      colours_of(m.kind), together ? 2 : 1);
  find_order({levels, 0}, tolerance, c);
  if (solves_exactly(m.kind)) {
    find_ssp_of_exact_collisions(form, b, tolerance, c);
  } else {
    find_ssp(b, tolerance, c);
  }
  find_structure(m, form, b, c);
  const bool complete = scope == certificate_scope::all;
  if (has_derivatives(m.kind) && (complete || m.claims.l_stable))
    c.stability = analyse_stability(m.coefficients<long double>());
  if (m.kind == method_kind::imex) {
    find_intermediate_regime(form, tolerance, c);
    if (complete) c.band = compute_intermediate_band(to_butcher(m.coefficients<long double>()));
  }
  check_claims(m, form, tolerance, c);
  if (together) {
    find_embedded_solution(m, *extended, {levels, 1}, c);
  } else if (extended) {
    order_levels<mp_real> own(to_butcher(extended->coefficients<mp_real>()), colours_of(m.kind), 1);
    find_embedded_solution(m, *extended, {own, 0}, c);
  }
  c.claims_hold = c.failures.empty();
  return c;
}

std::string certificate::remaining_terms() const {
  if (!keeps_slow_terms) return "none";
  return keeps_layer ? "all" : "slow";
}

void require_claims(const certificate& c) {
  if (c.claims_hold) return;
  throw claim_error(
      fmt::format("the claims of method '{}' do not hold:\n  {}", c.name, fmt::join(c.failures, "\n  ")));
}

}  // namespace apsis
