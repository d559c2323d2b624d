#include <algorithm>
#include <cmath>

#include <paper/certificate_findings.hpp>
#include <paper/claim.hpp>

namespace apsis::paper {
namespace C07_claim {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  result.findings = coefficient_findings("md-imex-6-3", 3, 0.904402174130635, 5e-16);
  result.findings.push_back(agrees_with_print("md-imex-6-3"));
  const auto form = find_method("md-imex-6-3").coefficients<double>();
  double least = 1.0;
  for (std::size_t i = 0; i < form.stages(); ++i)
    least = std::min(least, form.D(i, i) + std::abs(form.ddot[i]));
  result.findings.push_back(at_least("least d_ii + |ḋ_ii| over the stages", least, 1e-3));
  result.remarks = {
      "The printed digits cannot be completed within one unit of their last place: with the zeros fixed, "
      "every method that satisfies the conditions differs by at least 1.073 units in some coefficient. The "
      "catalogue contains a method at that distance, to 45 decimals."};
  return result;
}

}  // namespace
}  // namespace C07_claim

extern const claim_entry claim_C07;
const claim_entry claim_C07 = {.id = "C7",
                               .section = "New SSP IMEX multi-derivative Runge-Kutta methods",
                               .statement =
                                   "the six-stage IMEX method is of third order with r = 0.904402174130635; "
                                   "its printed Butcher form agrees",
                               .how = "certificate; r derived from the Butcher form alone",
                               .check = C07_claim::check};

}  // namespace apsis::paper
