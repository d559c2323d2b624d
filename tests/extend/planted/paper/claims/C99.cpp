#include <paper/claim.hpp>

namespace apsis::paper {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  result.findings = {exactly("files that a claim takes", 1, 1)};
  return result;
}

}  // namespace

extern const claim_entry claim_C99;
const claim_entry claim_C99 = {.id = "C99",
                               .section = "none",
                               .statement = "a claim is one file",
                               .how = "by planting one",
                               .check = check};

}  // namespace apsis::paper
