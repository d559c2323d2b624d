// Chain of n = S − 1 evaluations of T with r = n − 1, the largest r that n evaluations can have at second
// order. docs/methods.md proves order and signs, and that no other method has this n_F and r with S stages.
#include <apsis/method/family_parts.hpp>
#include <apsis/method/family_registry.hpp>

namespace apsis {
namespace chain_family {
namespace {

/// The free ḋ make the method third order where T = 0 and are spread evenly over the chain.
method make(std::size_t stages) {
  const long n = static_cast<long>(stages) - 1;
  const std::size_t last = stages - 1;
  method m;
  m.title = "second-order SSP multi-derivative IMEX method, transport in a chain";
  m.citation = "Apsis, docs/methods.md";
  m.origin =
      "Closed form: order 2 with n_F = S - 1 and r = S - 2 leaves no choice but that of ddot (proof in "
      "docs/methods.md).";
  m.purpose = "largest r/n_F";
  m.kind = method_kind::imex;
  m.claims.order = 2;
  m.claims.ssp_coefficient = std::to_string(n - 1);
  m.claims.type = "A";
  m.exact = empty_form(stages, std::to_string(n - 1));
  auto& form = m.exact;
  for (std::size_t i = 1; i < last; ++i) {
    form.W(i, i - 1) = "1";
    form.ddot[i] = fraction(-n, 12 * (n - 1) * (n - 1));
  }
  form.W(last, last - 1) = fraction(n - 1, n);
  form.P(last, 0) = fraction(1, n);
  form.D(0, 0) = form.D(last, last) = "1/2";
  form.ddot[0] = "-1/8";
  form.ddot[last] = "-1/24";
  return m;
}

}  // namespace
}  // namespace chain_family

extern const family_entry family_chain;
const family_entry family_chain = {.pattern = "md-imex-chain-S-2",
                                   .description = "second order, r = S - 2, n_F = S - 1 (docs/methods.md)",
                                   .lowest = 3,
                                   .highest = 64,
                                   .make = chain_family::make};

}  // namespace apsis
