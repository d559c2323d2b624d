#include <apsis/boundary/wall_values.hpp>

#include <apsis/core/errors.hpp>

#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

/// Throws an input error for a velocity along the normal of a wall at a point.
[[noreturn]] void refuse_along_normal(double normal, double t, const position& at, std::size_t dimensions,
                                      const char* why, const char* remedy) {
  throw input_error(fmt::format(
      "the velocity of a wall is {:g} along its normal at t = {:.10g} near ({:.6g}) ({}); {}", normal, t,
      fmt::join(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(dimensions), ", "), why, remedy));
}

}  // namespace

double accommodation_at(const face_quantity& accommodation, double t, const position& at) {
  const double alpha = accommodation.at(t, at);
  if (!(alpha >= 0.0 && alpha <= 1.0))
    throw input_error(
        fmt::format("the accommodation of a diffuse wall is {:g} at t = {:.10g} (a number "
                    "from 0 to 1 is needed); change it",
                    alpha, t));
  return alpha;
}

std::array<double, 3> velocity_along(const std::vector<face_quantity>& velocity, const face& where, double t,
                                     const position& at) {
  std::array<double, 3> u{};
  for (std::size_t k = 0; k < velocity.size(); ++k) u[k] = velocity[k].at(t, at);
  if (const double normal = u[static_cast<std::size_t>(where.direction)]; normal != 0.0)
    refuse_along_normal(normal, t, at, velocity.size(), "the domain would have to move", "give 0 there");
  return u;
}

std::array<double, 3> velocity_along(const std::vector<face_quantity>& velocity, const wall_point& where) {
  std::array<double, 3> u{};
  double normal = 0.0, square = 0.0;
  for (std::size_t k = 0; k < velocity.size(); ++k) {
    u[k] = velocity[k].at(where.t, where.at);
    normal += u[k] * where.normal[k];
    square += u[k] * u[k];
  }
  // Pieces are chords of a curved wall, which deviate from it by less.
  constexpr double most_of_square = 0.25;
  if (normal * normal > most_of_square * square)
    refuse_along_normal(normal, where.t, where.at, velocity.size(), "the body would have to move",
                        "give a velocity along the wall");
  for (std::size_t k = 0; k < velocity.size(); ++k) u[k] -= normal * where.normal[k];
  return u;
}

}  // namespace apsis
