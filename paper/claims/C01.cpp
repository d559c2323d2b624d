#include <paper/claim.hpp>
#include <paper/condition_tables.hpp>

namespace apsis::paper {
namespace C01_claim {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  result.findings =
      condition_findings(tree_colours::G_only, printed_implicit_conditions, {4, 8}, {{5, 9}, {6, 20}});
  return result;
}

}  // namespace
}  // namespace C01_claim

extern const claim_entry claim_C01;
const claim_entry claim_C01 = {
    .id = "C1",
    .section = "Formulating the order conditions",
    .statement = "order conditions of implicit two-derivative Runge-Kutta methods up to order 4",
    .how = "generated from rooted trees and compared with the printed table term by term",
    .check = C01_claim::check};

}  // namespace apsis::paper
