#include <paper/certificate_findings.hpp>
#include <paper/claim.hpp>

namespace apsis::paper {
namespace C05_claim {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  result.findings = unconditional_findings("imdrk-5-4", 4);
  result.findings.push_back(agrees_with_print("imdrk-5-4"));
  result.remarks = {
      "The printed Butcher entries off the diagonal have their two indices swapped (the matrices are lower "
      "triangular): read a_21 for a_12 and so on. With this correction every printed digit agrees."};
  return result;
}

}  // namespace
}  // namespace C05_claim

extern const claim_entry claim_C05;
const claim_entry claim_C05 = {
    .id = "C5",
    .section = "New SSP implicit two-derivative Runge-Kutta methods",
    .statement = "the five-stage method is of fourth order and SSP for every step; its printed forms agree",
    .how = "certificate; conversion of the Shu-Osher form compared with the printed matrices",
    .check = C05_claim::check};

}  // namespace apsis::paper
