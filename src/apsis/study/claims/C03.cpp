#include <apsis/method/certificate.hpp>
#include <apsis/study/claim.hpp>

namespace apsis {
namespace {

claim_result check(const study_control&) {
  const certificate& c = find_certificate("imdrk-1-2");
  claim_result result;
  result.findings = {
      exactly("order", c.order, 2),
      at_most("largest residual of the order conditions", static_cast<double>(c.order_residual), 1e-38),
      holds("unconditionally SSP: R e ≥ 0, P ≥ 0, D ≥ 0, Ḋ ≤ 0", c.unconditional),
      exactly("stages", static_cast<long>(find_method("imdrk-1-2").stages()), 1)};
  return result;
}

}  // namespace

extern const claim_entry claim_C03;
const claim_entry claim_C03 = {
    "C3", "SSP implicit two-derivative methods, new methods up to order 4",
    "the one-stage implicit Taylor method is of second order and unconditionally SSP",
    "certificate of the method from its coefficients alone", check};

}  // namespace apsis
