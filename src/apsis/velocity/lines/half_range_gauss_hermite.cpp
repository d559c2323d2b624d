#include <apsis/core/errors.hpp>
#include <apsis/velocity/gauss_rule.hpp>
#include <apsis/velocity/velocity_line_registry.hpp>

#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace half_range_gauss_hermite_line {
namespace {

velocity_line make(int points, double max) {
  if (points % 2 != 0)
    throw input_error(fmt::format("velocity.points = {} cannot be halved (one half moves each way); give {}",
                                  points, points + 1));
  const gauss_rule half = half_range_gauss_hermite(points / 2);
  const double scale = max > 0.0 ? max / half.nodes.back() : 1.0;
  std::vector<double> v, w;
  for (std::size_t j = half.nodes.size(); j-- > 0;) {
    v.push_back(-scale * half.nodes[j]);
    w.push_back(scale * half.weights[j]);
  }
  for (std::size_t j = 0; j < half.nodes.size(); ++j) {
    v.push_back(scale * half.nodes[j]);
    w.push_back(scale * half.weights[j]);
  }
  return {std::move(v), std::move(w)};
}

}  // namespace
}  // namespace half_range_gauss_hermite_line

extern const velocity_line_entry velocity_line_half_range_gauss_hermite;
const velocity_line_entry velocity_line_half_range_gauss_hermite = {
    .name = "half-range-gauss-hermite",
    .description =
        "Gauss points of exp(-v^2/2) on v > 0 and v < 0, or scaled to end at max: few for small "
        "deviations from one Maxwellian that jump at v = 0",
    .source = "Ghiroldi, Gibelli, J. Comput. Phys. 258 (2014)",
    .needs_max = false,
    .make = half_range_gauss_hermite_line::make};

}  // namespace apsis
