#include <apsis/method/certificate.hpp>

#include <paper/claim.hpp>

namespace apsis::paper {
namespace C09_claim {
namespace {

claim_result check(const study_control&) {
  const certificate& ours = find_certificate("md-imex-3-2");
  const certificate& theirs = find_certificate("hsz-ars-4-2");
  const double ratio = mp_real(ours.ssp_coefficient / theirs.ssp_coefficient).convert_to<double>();
  claim_result result;
  result.findings = {
      close_to(
          "r of the second-order method of the paper relative to that of Hu, Shu and Zhang, percent larger",
          100.0 * (ratio - 1.0), 23.0, 0.5),
      exactly("order of the method of Hu, Shu and Zhang", theirs.order, 2),
      is_true("it is SSP without a bound from Q", theirs.unconditional),
      close_to("its r, from its Butcher form alone", static_cast<double>(theirs.ssp_coefficient), 0.8125,
               1e-15),
      close_to("r of the second-order method of the paper", static_cast<double>(ours.ssp_coefficient), 1.0,
               1e-15)};
  result.remarks = {
      "The correction step of their scheme counts as a fifth stage here; the scheme is of type ARS, so the "
      "limit requires consistent data, unlike that of the paper."};
  return result;
}

}  // namespace
}  // namespace C09_claim

extern const claim_entry claim_C09;
const claim_entry claim_C09 = {
    .id = "C9",
    .section = "New SSP IMEX multi-derivative Runge-Kutta methods",
    .statement = "r = 1 is 23 % larger than that of the second-order scheme of Hu, Shu and Zhang (2018)",
    .how = "their scheme is in the catalogue; both coefficients derived from the Butcher forms alone",
    .check = C09_claim::check};

}  // namespace apsis::paper
