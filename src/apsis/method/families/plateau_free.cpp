// Methods with n = S − 2 evaluations of T, r = n − 1 and exact O(ε) terms for ε ≪ Δt. Derivation:
// docs/plateaus.md.
#include <apsis/method/family_parts.hpp>
#include <apsis/method/family_registry.hpp>

namespace apsis {
namespace plateau_free_family {
namespace {

/// Order 2 leaves one condition, ḋ_2 + (n−1) ḋ_{n+1} = −(n² − 3n + 4)/n². Two equal terms on the left give an
/// error constant within 2 % of the smallest for every n. The member with n = 3 is md-imex-5-2.
method make(std::size_t stages) {
  const long n = static_cast<long>(stages) - 2;
  const std::size_t last = stages - 1;
  method m;
  m.title = "second-order SSP multi-derivative IMEX method without O(epsilon) plateaus";
  m.citation = "Apsis, docs/plateaus.md";
  m.origin =
      "Closed form: the optimal explicit second-order method, with one relaxed stage beside the chain.";
  m.purpose = "no O(epsilon) plateau";
  m.kind = method_kind::imex;
  m.claims.order = 2;
  m.claims.ssp_coefficient = std::to_string(n - 1);
  m.claims.type = "A";
  m.exact = empty_form(stages, std::to_string(n - 1));
  auto& form = m.exact;
  form.P(1, 0) = "1";
  form.P(last, 1) = fraction(1, n);
  form.D(0, 0) = form.D(last, last) = fraction(1, n);
  form.D(1, 1) = fraction(n - 2, n);
  for (std::size_t i = 2; i < last; ++i) {
    form.W(i, i == 2 ? 0 : i - 1) = "1";
    form.D(i, i) = fraction(n - 2, n * (n - 1));
  }
  form.W(last, last - 1) = fraction(n - 1, n);
  form.ddot[1] = fraction(-(n * n - 3 * n + 4), 2 * n * n);
  form.ddot[last - 1] = fraction(-(n * n - 3 * n + 4), 2 * n * n * (n - 1));
  return m;
}

}  // namespace
}  // namespace plateau_free_family

extern const family_entry family_plateau_free;
const family_entry family_plateau_free = {
    .pattern = "md-imex-plateau-free-S-2",
    .description = "second order, r = S - 3, n_F = S - 2, no O(epsilon) plateaus (docs/plateaus.md)",
    .lowest = 5,
    .highest = 64,
    .make = plateau_free_family::make};

}  // namespace apsis
