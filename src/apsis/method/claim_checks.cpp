#include <apsis/method/claim_checks.hpp>

#include <apsis/method/coefficient.hpp>

#include <fmt/format.h>

namespace apsis {
void check_order_claim(const method& m, certificate& c) {
  if (c.order == m.claims.order) return;
  if (c.order > m.claims.order) {
    c.failures.push_back(
        fmt::format("claims.order = {} but the method has order {}", m.claims.order, c.order));
    return;
  }
  for (const auto& condition : c.next)
    c.failures.push_back(fmt::format("order {}: the condition of tree {} is {} instead of {} (residual {})",
                                     condition.order, condition.tree, short_text(condition.value),
                                     short_text(condition.wanted),
                                     mp_real(condition.value - condition.wanted).str(3)));
}

namespace {

/// Whether a claimed number agrees with the computed one: to two units of its last decimal or, if it is
/// exact, to the accuracy of the radius. The radius counts values down to −tolerance as nonnegative. This
/// shifts it by the tolerance times a product of a few coefficients.
bool agrees(const std::string& claimed, const mp_real& found, const mp_real& tolerance) {
  const int digits = decimals(claimed);
  const mp_real allowed = digits > 0 ? 2 * pow(mp_real(10), -digits) : 1000 * tolerance;
  return abs(found - coefficient_value(claimed)) <= allowed;
}

void check_ssp_claim(const method& m, const mp_real& tolerance, certificate& c) {
  if (m.claims.explicit_radius && !agrees(*m.claims.explicit_radius, c.explicit_radius, tolerance))
    c.failures.push_back(fmt::format("claims.explicit_radius = {} but A_hat gives {}",
                                     *m.claims.explicit_radius, c.explicit_radius.str(17)));
  if (!m.claims.ssp_coefficient) return;
  const std::string& claimed = *m.claims.ssp_coefficient;
  if (claimed == "unconditional") {
    if (!c.unconditional || c.bounded)
      c.failures.push_back(fmt::format("not unconditionally SSP: {}", c.limiting_entry.empty()
                                                                          ? "the explicit part sets a bound"
                                                                          : c.limiting_entry));
    return;
  }
  const bool none = !c.bounded;
  if (none || !agrees(claimed, c.ssp_coefficient, tolerance))
    c.failures.push_back(fmt::format("claims.ssp_coefficient = {} but the Butcher form gives {}{}", claimed,
                                     none ? std::string("no bound") : c.ssp_coefficient.str(17),
                                     c.limiting_entry.empty() ? "" : " (" + c.limiting_entry + ")"));
}

void check_structure_claims(const method& m, certificate& c) {
  if (m.claims.type && *m.claims.type != c.type)
    c.failures.push_back(
        fmt::format("claims.type = {} but the method is of type {}", *m.claims.type, c.type));
  if (m.claims.l_stable && *m.claims.l_stable != c.stability.l_stable)
    c.failures.push_back(fmt::format(
        "claims.l_stable = {} but the implicit part is A({:.4f} degrees)-stable with |R(-infinity)| = {:.3g}",
        *m.claims.l_stable, c.stability.angle, c.stability.at_infinity));
}

void check_intermediate_claim(const method& m, certificate& c) {
  const auto& claimed = m.claims.intermediate;
  if (!claimed || (c.keeps_slow_terms && (c.keeps_layer || *claimed == "slow"))) return;
  c.failures.push_back(
      c.regime.applies
          ? fmt::format(
                "claims.intermediate = {} but the O(epsilon) terms are flux {}, last stage {}, layer {} "
                "times the exact ones",
                *claimed, c.regime.flux.str(17), c.regime.last.str(17), c.regime.layer.str(17))
          : fmt::format("claims.intermediate = {} but a stage is neither relaxed nor u^n", *claimed));
}

/// Checks that the weights of the form are convex, and that r of the file is at most the SSP coefficient. The
/// step-size rule uses this r.
void check_form(const method& m, const shu_osher_form<mp_real>& form, const mp_real& tolerance,
                certificate& c) {
  if (!c.bounded || c.ssp_coefficient == 0) return;
  if (form.r > c.ssp_coefficient + tolerance)
    c.failures.push_back(
        fmt::format("shu_osher.r = {} is larger than the SSP coefficient {} of the Butcher form", m.exact.r,
                    c.ssp_coefficient.str(17)));
  const auto initial = initial_weights(form);
  std::vector<bool> is_initial;  // stages that are u^n itself
  for (std::size_t i = 0; i < form.stages(); ++i) {
    is_initial.push_back(initial[i] == 1 && form.D(i, i) == 0 && form.ddot[i] == 0);
    for (std::size_t j = 0; j < i; ++j)
      if (is_initial[j] && abs(initial[i]) > tolerance && form.P(i, j) + form.W(i, j) != 0)
        c.failures.push_back(fmt::format(
            "row {} gives weight to u^n twice (R e = {} and stage {}, which is u^n): the form is not unique",
            i + 1, short_text(initial[i]), j + 1));
    const auto negative = [&](const char* what, std::size_t j, const mp_real& value) {
      c.failures.push_back(fmt::format("shu_osher.{}_{},{} = {} is negative: the form is not convex", what,
                                       i + 1, j, short_text(value)));
    };
    if (initial[i] < -tolerance) negative("R e", 0, initial[i]);
    for (std::size_t j = 0; j < i; ++j) {
      if (form.P(i, j) < 0) negative("P", j + 1, form.P(i, j));
      if (form.W(i, j) < 0) negative("W", j + 1, form.W(i, j));
    }
  }
}

}  // namespace

void check_claims(const method& m, const shu_osher_form<mp_real>& form, const mp_real& tolerance,
                  certificate& c) {
  check_order_claim(m, c);
  check_ssp_claim(m, tolerance, c);
  check_form(m, form, tolerance, c);
  check_structure_claims(m, c);
  check_intermediate_claim(m, c);
}

}  // namespace apsis
