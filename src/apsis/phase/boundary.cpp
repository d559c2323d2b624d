#include <apsis/phase/boundary.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace apsis {

std::shared_ptr<const boundary> boundary::prepared(const face&, const velocity_set&) const {
  return nullptr;
}

std::optional<int> boundary::repeated_cell(int, int) const {
  return std::nullopt;
}

void repeating_boundary::fill(const face&, double, const pencil_end& rows) const {
  const int cells = static_cast<int>(rows.inside.size());
  for (std::size_t g = 0; g < rows.ghosts.size(); ++g) {
    const auto cell = static_cast<std::size_t>(*repeated_cell(static_cast<int>(g), cells));
    std::copy_n(rows.inside[cell], rows.components, rows.ghosts[g]);
  }
}

namespace {

/// Largest ratio of the first step of a continuation to the smaller of two neighbouring differences.
constexpr double steepest = 3.0;

/// Returns the factor that scales a change to at most `steepest` times the smaller of two differences.
double limited(double change, double first, double second) {
  const double most = steepest * std::min(std::abs(first), std::abs(second));
  return std::abs(change) > most ? most / std::abs(change) : 1.0;
}

/// The continuation of three cell averages beyond the face.
struct continuation {
  double first, slope, curvature, factor;

  continuation(double a0, double a1, double a2)
      : first(a0),
        slope(a0 - a1),
        curvature(a0 - 2.0 * a1 + a2),
        factor(limited(slope + curvature, slope, a1 - a2)) {}
  double average(double ghost) const {
    return first + factor * ghost * (slope + 0.5 * (ghost + 1.0) * curvature);
  }
};

}  // namespace

void boundary::incoming(const face&, double, const position&, const double*, double*) const {}

void boundary::incoming_beside(const face& where, double t, const position& at, const double* outgoing,
                               std::span<const double* const>, double* values) const {
  incoming(where, t, at, outgoing, values);
}

std::vector<double> entering_components(const face& where, const velocity_set& velocities) {
  std::vector<double> enters;
  for (const double v : velocities.speeds(where.direction))
    enters.push_back((where.upper ? v < 0.0 : v > 0.0) ? 1.0 : 0.0);
  return enters;
}

void incoming_boundary::fill(const face&, double, const pencil_end& rows) const {
  const auto width = static_cast<std::size_t>(rows.components);
  const std::size_t cells = rows.inside.size();
  const double *a0 = rows.inside[0], *a1 = rows.inside[std::min<std::size_t>(1, cells - 1)],
               *a2 = rows.inside[std::min<std::size_t>(2, cells - 1)];
  for (std::size_t g = 0; g < rows.ghosts.size(); ++g)
    for (std::size_t k = 0; k < width; ++k)
      rows.ghosts[g][k] = continuation(a0[k], a1[k], a2[k]).average(static_cast<double>(g + 1));
}

}  // namespace apsis
