#include <apsis/method/certificate.hpp>

#include <tuple>

#include <fmt/format.h>
#include <paper/claim.hpp>

namespace apsis::paper {
namespace C08_claim {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  for (const auto& [name, solves, evaluations] :
       {std::tuple{"md-imex-3-2", 3, 2}, std::tuple{"md-imex-6-3", 6, 3}}) {
    const certificate& c = find_certificate(name);
    result.findings.push_back(is_true(fmt::format("{} is of type A", name), c.type == "A"));
    result.findings.push_back(is_true(fmt::format("{} is GSA: u^(n+1) = u_s", name), c.gsa));
    result.findings.push_back(
        exactly(fmt::format("implicit solves per step of {}", name), c.implicit_solves, solves));
    result.findings.push_back(exactly(fmt::format("transport evaluations per step of {}", name),
                                      c.explicit_evaluations, evaluations));
  }
  return result;
}

}  // namespace
}  // namespace C08_claim

extern const claim_entry claim_C08;
const claim_entry claim_C08 = {
    .id = "C8",
    .section = "New SSP IMEX multi-derivative Runge-Kutta methods",
    .statement =
        "both IMEX methods are of type A and globally stiffly accurate, with three and six implicit solves",
    .how = "certificate",
    .check = C08_claim::check};

}  // namespace apsis::paper
