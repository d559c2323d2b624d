#include <apsis/study/certificate_findings.hpp>

namespace apsis {

std::vector<finding> certificate_findings(const std::string& method, int order) {
  const certificate& c = find_certificate(method);
  // The catalogue carries 45 decimals.
  return {exactly("order", c.order, order),
          at_most("largest residual of its order conditions", static_cast<double>(c.order_residual), 1e-38)};
}

}  // namespace apsis
