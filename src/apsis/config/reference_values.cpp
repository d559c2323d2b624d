#include <apsis/config/reference_values.hpp>

#include <cmath>
#include <cstddef>
#include <numeric>

namespace apsis {
namespace {

double norm(const std::vector<double>& x) {
  double square = 0.0;
  for (const double one : x) square += one * one;
  return std::sqrt(square);
}

}  // namespace

double reference_values::speed() const {
  return norm(velocity);
}

double reference_values::dynamic_pressure() const {
  return 0.5 * density * speed() * speed();
}

std::vector<double> reference_values::lift_direction() const {
  const double all = speed();
  if (about_axis) return {};
  if (velocity.size() == 2) return {-velocity[1] / all, velocity[0] / all};
  if (up.empty()) return {};
  const double along = std::inner_product(up.begin(), up.end(), velocity.begin(), 0.0) / (all * all);
  std::vector<double> across = up;
  for (std::size_t k = 0; k < across.size(); ++k) across[k] -= along * velocity[k];
  const double length_across = norm(across);
  for (double& x : across) x /= length_across;
  return across;
}

const std::vector<reference_key>& reference_keys() {
  using r = reference_values;
  static const std::vector<reference_key> keys = {
      {"density", dimensions::density, &r::density, nullptr, true, true, 0, true, "density of the stream"},
      {"velocity", dimensions::velocity, nullptr, &r::velocity, false, true, 0, true,
       "velocity U of the stream, with a component for each direction of space"},
      {"temperature", dimensions::temperature, &r::temperature, nullptr, true, true, 0, true,
       "temperature of the stream, for C_p"},
      {"length", dimensions::length, &r::length, nullptr, true, true, 0, true,
       "length of the body: in the plane of forces and torques, in space and about an axis of torques"},
      {"area", dimensions::length * dimensions::length, &r::area, nullptr, true, true, 3, true,
       "area of the body, of forces and torques"},
      {"centre", dimensions::length, nullptr, &r::centre, false, false, 0, false,
       "point about which the moment is taken; the origin where not given"},
      {"up", dimensions::none, nullptr, &r::up, false, false, 3, false,
       "vector: lift is the force along its part across U; no lift where not given"}};
  return keys;
}

}  // namespace apsis
