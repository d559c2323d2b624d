#include <paper/certificate_findings.hpp>
#include <paper/claim.hpp>

namespace apsis::paper {
namespace C03_claim {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  result.findings = unconditional_findings("imdrk-1-2", 2);
  const auto& stability = find_certificate("imdrk-1-2").stability;
  result.findings.push_back(close_to("angle of A(α)-stability, degrees", stability.angle, 90.0, 0.0));
  result.findings.push_back(at_least("smallest value of R(z) = 1/(1 - z + z²/2) on the negative axis",
                                     stability.smallest_on_negative_axis, 0.0));
  return result;
}

}  // namespace
}  // namespace C03_claim

extern const claim_entry claim_C03;
const claim_entry claim_C03 = {
    .id = "C3",
    .section = "New SSP implicit two-derivative Runge-Kutta methods",
    .statement = "the one-stage implicit Taylor method is of second order and SSP for every step",
    .how = "certificate from the coefficients alone",
    .check = C03_claim::check};

}  // namespace apsis::paper
