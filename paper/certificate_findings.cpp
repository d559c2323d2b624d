#include <paper/certificate_findings.hpp>

#include <paper/paper_tables.hpp>

namespace apsis::paper {

std::vector<finding> certificate_findings(const std::string& method, int order) {
  const certificate& c = find_certificate(method);
  // The catalogue has 45 decimals.
  return {exactly("order", c.order, order),
          at_most("largest residual of its order conditions", static_cast<double>(c.order_residual), 1e-38)};
}

std::vector<finding> unconditional_findings(const std::string& method, int order) {
  auto findings = certificate_findings(method, order);
  findings.push_back(
      is_true("unconditionally SSP: R e, P, D ≥ 0 and Ḋ ≤ 0", find_certificate(method).unconditional));
  return findings;
}

std::vector<finding> coefficient_findings(const std::string& method, int order, double r, double tolerance) {
  auto findings = certificate_findings(method, order);
  findings.push_back(close_to("SSP coefficient r from the Butcher form alone",
                              static_cast<double>(find_certificate(method).ssp_coefficient), r, tolerance));
  return findings;
}

finding agrees_with_print(const std::string& method) {
  return at_most("largest difference from the printed Butcher form", distance_to_print(method), 1e-14);
}

}  // namespace apsis::paper
