#include <apsis/study/certificate_findings.hpp>
#include <apsis/study/claim.hpp>
#include <apsis/study/paper_tables.hpp>

namespace apsis {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  result.findings = certificate_findings("imdrk-5-4", 4);
  result.findings.push_back(
      holds("unconditionally SSP: R e, P, D ≥ 0 and Ḋ ≤ 0", find_certificate("imdrk-5-4").unconditional));
  result.findings.push_back(
      at_most("largest difference from the printed Butcher form", distance_to_print("imdrk-5-4"), 1e-14));
  result.remarks = {
      "The printed Butcher entries off the diagonal have their two indices swapped (the matrices are lower "
      "triangular): read a_21 for a_12 and so on. With that, every printed digit agrees."};
  return result;
}

}  // namespace

extern const claim_entry claim_C05;
const claim_entry claim_C05 = {
    "C5", "New SSP implicit two-derivative Runge-Kutta methods",
    "the five-stage method is of fourth order and SSP for every step; its printed forms agree",
    "certificate; conversion of the Shu-Osher form compared with the printed matrices", check};

}  // namespace apsis
