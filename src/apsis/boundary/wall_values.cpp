#include <apsis/boundary/wall_values.hpp>

#include <apsis/boundary/face_value_error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

/// Throws input_error for a velocity of a wall along its normal.
[[noreturn]] void refuse_along_normal(const std::vector<face_quantity>& velocity, double normal, double t,
                                      const position& at, const char* why, const char* remedy) {
  const face_quantity& given = velocity.front();
  const auto* origin = given.origin();
  const auto dimensions = origin != nullptr ? origin->dimensions : static_cast<int>(velocity.size());
  refuse_value(
      given, fmt::format("the velocity of {} is {:g} along its normal at t = {:.10g} near ({:.6g}) ({}); {}",
                         surface_of(given, "a wall"), normal, t,
                         fmt::join(at.begin(), at.begin() + dimensions, ", "), why, remedy));
}

}  // namespace

double accommodation_at(const face_quantity& accommodation, double t, const position& at) {
  const double alpha = accommodation.at(t, at);
  if (!(alpha >= 0.0 && alpha <= 1.0))
    refuse_value(
        accommodation,
        fmt::format("the accommodation of {} is {:g} at {} (a number from 0 to 1 is needed); change it",
                    surface_of(accommodation, "a diffuse wall"), alpha,
                    time_and_point(accommodation, t, at)));
  return alpha;
}

std::array<double, 3> velocity_along(const std::vector<face_quantity>& velocity, const face& where, double t,
                                     const position& at) {
  std::array<double, 3> u{};
  for (std::size_t k = 0; k < velocity.size(); ++k) u[k] = velocity[k].at(t, at);
  if (const double normal = u[static_cast<std::size_t>(where.direction)]; normal != 0.0)
    refuse_along_normal(velocity, normal, t, at, "the domain would have to move", "give 0 there");
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
  // Pieces are chords of a curved wall. The angles between them and the wall cause smaller components.
  constexpr double most_of_square = 0.25;
  if (normal * normal > most_of_square * square)
    refuse_along_normal(velocity, normal, where.t, where.at, "the body would have to move",
                        "give a velocity along the wall");
  for (std::size_t k = 0; k < velocity.size(); ++k) u[k] -= normal * where.normal[k];
  return u;
}

}  // namespace apsis
