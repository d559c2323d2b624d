#include <paper/claim.hpp>
#include <paper/square_decay.hpp>

namespace apsis::paper {
namespace C11_claim {
namespace {

/// Returns the largest step for which every stage of 20 steps is positive, by bisection.
double positivity_limit(const std::string& method) {
  double keeps = 1e-3, loses = 0.1;
  for (int n = 0; n < 60; ++n) {
    const double dt = (keeps + loses) / 2.0;
    const auto run = square_decay(method, dt, 20);
    (run.solvable && run.positive ? keeps : loses) = dt;
  }
  return keeps;
}

claim_result check(const study_control&) {
  claim_result result;
  // At the limit a stage vanishes, and rounding decides its sign: 1e-12 is generous.
  result.findings = {close_to("largest step of dirk-2-2 that keeps every stage positive",
                              positivity_limit("dirk-2-2"), 1.0 / 50, 1e-12),
                     close_to("largest step of dirk-4-3 that keeps every stage positive",
                              positivity_limit("dirk-4-3"), 1.0 / 75, 1e-12)};
  result.remarks = {
      "The first implicit stage of both methods starts from u^n + a dt G(u^n) = 10 - 1000 a dt, with a = 1/2 "
      "and 3/4: it changes sign at dt = 1/50 and 1/75."};
  return result;
}

}  // namespace
}  // namespace C11_claim

extern const claim_entry claim_C11;
const claim_entry claim_C11 = {
    .id = "C11",
    .section = "Numerical results, the implicit methods on u' = -10 u^2",
    .statement = "the DIRK methods of second and third order lose positivity for steps above 1/50 and 1/75",
    .how = "bisection of the step for which every stage of twenty steps from u(0) = 10 is positive",
    .check = C11_claim::check};

}  // namespace apsis::paper
