#include <apsis/velocity/polar_rings.hpp>

#include <apsis/core/errors.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>

#include <fmt/format.h>

namespace apsis {

polar_rings::polar_rings(int rings, int angles, double max) : rings_(rings), angles_(angles) {
  if (rings < 4)
    throw input_error(
        fmt::format("velocity.rings = {} is too few (an equilibrium needs 4); give at least 4", rings));
  if (angles < 12 || angles % 4 != 0)
    throw input_error(
        fmt::format("velocity.angles = {} is not possible (mirror images of all angles are needed, and at "
                    "least 12); give {}",
                    angles, angles < 12 ? 12 : (angles + 3) / 4 * 4));
  if (!(max > 0.0) || std::isinf(max))
    throw input_error(fmt::format("velocity.max_across = {} is not positive and finite; change it", max));
  const double part = 1.0 / rings, angle = 2.0 * std::numbers::pi / angles;
  for (int ring = 0; ring < rings; ++ring) {
    const double s = (ring + 0.5) * part;
    speeds_.push_back(max * s * s);
    weights_.push_back(speeds_.back() * 2.0 * max * s * part * angle);
  }
  for (int a = 0; a < angles / 4; ++a) quarter_.push_back(std::cos((a + 0.5) * angle));
}

double polar_rings::cosine(int angle) const {
  const int quarter = angles_ / 4, a = (angle % angles_ + angles_) % angles_;
  const int within = a % quarter;
  const auto near = static_cast<std::size_t>(within), far = static_cast<std::size_t>(quarter - 1 - within);
  switch (a / quarter) {
    case 0:
      return quarter_[near];
    case 1:
      return -quarter_[far];
    case 2:
      return -quarter_[near];
    default:
      return quarter_[far];
  }
}

}  // namespace apsis
