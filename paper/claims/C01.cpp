#include <paper/claim.hpp>
#include <paper/condition_tables.hpp>

namespace apsis {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  result.findings =
      condition_findings(tree_colours::G_only, printed_implicit_conditions, {4, 8}, {{5, 9}, {6, 20}});
  return result;
}

}  // namespace

extern const claim_entry claim_C01;
const claim_entry claim_C01 = {
    "C1", "Formulating the order conditions",
    "order conditions of implicit two-derivative Runge-Kutta methods up to order 4",
    "generated from rooted trees and compared with the printed table term by term", check};

}  // namespace apsis
