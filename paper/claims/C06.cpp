#include <paper/certificate_findings.hpp>
#include <paper/claim.hpp>

namespace apsis::paper {
namespace C06_claim {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  result.findings = coefficient_findings("md-imex-3-2", 2, 1.0, 0.0);
  result.findings.push_back(agrees_with_print("md-imex-3-2"));
  return result;
}

}  // namespace
}  // namespace C06_claim

extern const claim_entry claim_C06;
const claim_entry claim_C06 = {
    .id = "C6",
    .section = "New SSP IMEX multi-derivative Runge-Kutta methods",
    .statement = "the three-stage IMEX method is of second order with r = 1; its printed Butcher form agrees",
    .how = "certificate; r derived from the Butcher form alone",
    .check = C06_claim::check};

}  // namespace apsis::paper
