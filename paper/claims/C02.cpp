#include <paper/claim.hpp>
#include <paper/condition_tables.hpp>

namespace apsis::paper {
namespace C02_claim {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  result.findings =
      condition_findings(tree_colours::both, printed_imex_conditions, {3, 20}, {{4, 52}, {5, 214}});
  return result;
}

}  // namespace
}  // namespace C02_claim

extern const claim_entry claim_C02;
const claim_entry claim_C02 = {
    .id = "C2",
    .section = "Formulating order conditions",
    .statement = "order conditions of multi-derivative IMEX Runge-Kutta methods up to order 3",
    .how = "generated from two-coloured rooted trees and compared with the printed table term by term",
    .check = C02_claim::check};

}  // namespace apsis::paper
