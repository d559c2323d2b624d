#include <apsis/study/certificate_findings.hpp>
#include <apsis/study/claim.hpp>
#include <apsis/study/paper_tables.hpp>

namespace apsis {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  result.findings = certificate_findings("imdrk-2-3", 3);
  result.findings.push_back(
      holds("unconditionally SSP: R e, P, D ≥ 0 and Ḋ ≤ 0", find_certificate("imdrk-2-3").unconditional));
  result.findings.push_back(
      at_most("largest difference from the printed Butcher form", distance_to_print("imdrk-2-3"), 1e-14));
  return result;
}

}  // namespace

extern const claim_entry claim_C04;
const claim_entry claim_C04 = {
    "C4", "New SSP implicit two-derivative Runge-Kutta methods",
    "the two-stage method is of third order and SSP for every step; its printed forms agree",
    "certificate; conversion of the Shu-Osher form compared with the printed matrices", check};

}  // namespace apsis
