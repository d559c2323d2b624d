#include <apsis/body/rotation.hpp>

#include <apsis/body/internal/vectors.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>

namespace apsis {

angle_functions functions_of_degrees(double degrees) {
  // The remainders are exact. Multiples of 90° leave the angle 0, for which cosine and sine are exact too.
  const double turn = std::remainder(degrees, 360.0);
  const double rest = std::remainder(turn, 90.0);
  const auto quarters = static_cast<int>(std::lround((turn - rest) / 90.0));
  const double radians = rest * (std::numbers::pi / 180.0);
  const double c = std::cos(radians), s = std::sin(radians);
  switch ((quarters + 4) % 4) {
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    case 3:
      return {s, -c};
    default:
      return {c, s};
  }
}

rotation::rotation(const position& unit_axis, double degrees) {
  const auto [c, s] = functions_of_degrees(degrees);
  const position& a = unit_axis;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    rows_[i][i] = std::lerp(c, 1.0, a[i] * a[i]);  // exact for a component 0 or ±1
    rows_[i][j] = (1.0 - c) * a[i] * a[j] - s * a[k];
    rows_[i][k] = (1.0 - c) * a[i] * a[k] + s * a[j];
  }
}

position rotation::apply(const position& x) const {
  return {vectors::dot(rows_[0], x), vectors::dot(rows_[1], x), vectors::dot(rows_[2], x)};
}

position rotation::apply_inverse(const position& x) const {
  position y = {};
  for (std::size_t i = 0; i < 3; ++i) y[i] = rows_[0][i] * x[0] + rows_[1][i] * x[1] + rows_[2][i] * x[2];
  return y;
}

bool rotation::is_identity() const {
  return rows_ == rotation().rows_;
}

}  // namespace apsis
