#include <paper/certificate_findings.hpp>
#include <paper/claim.hpp>

namespace apsis::paper {
namespace C04_claim {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  result.findings = unconditional_findings("imdrk-2-3", 3);
  result.findings.push_back(agrees_with_print("imdrk-2-3"));
  return result;
}

}  // namespace
}  // namespace C04_claim

extern const claim_entry claim_C04;
const claim_entry claim_C04 = {
    .id = "C4",
    .section = "New SSP implicit two-derivative Runge-Kutta methods",
    .statement = "the two-stage method is of third order and SSP for every step; its printed forms agree",
    .how = "certificate; conversion of the Shu-Osher form compared with the printed matrices",
    .check = C04_claim::check};

}  // namespace apsis::paper
