#include <apsis/velocity/gauss_rule.hpp>
#include <apsis/velocity/velocity_line_registry.hpp>

#include <utility>

namespace apsis {
namespace gauss_hermite_line {
namespace {

velocity_line make(int points, double max) {
  gauss_rule rule = gauss_hermite(points);
  const double scale = max > 0.0 ? max / rule.nodes.back() : 1.0;
  for (double& v : rule.nodes) v *= scale;
  for (double& w : rule.weights) w *= scale;
  return {std::move(rule.nodes), std::move(rule.weights)};
}

}  // namespace
}  // namespace gauss_hermite_line

extern const velocity_line_entry velocity_line_gauss_hermite;
const velocity_line_entry velocity_line_gauss_hermite = {
    .name = "gauss-hermite",
    .description =
        "Gauss-Hermite points of temperature 1, or scaled to end at max: few for small deviations "
        "from one Maxwellian",
    .source = "Shan, Yuan, Chen, J. Fluid Mech. 550 (2006)",
    .needs_max = false,
    .make = gauss_hermite_line::make};

}  // namespace apsis
