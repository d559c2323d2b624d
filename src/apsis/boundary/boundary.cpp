#include <apsis/boundary/boundary.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace apsis {

std::shared_ptr<const boundary> boundary::prepared(const face&, const velocity_set&) const {
  return nullptr;
}

std::optional<int> boundary::cell_of_ghost(int, int) const {
  return std::nullopt;
}

void repeating_boundary::fill(const face&, double, const pencil_end& rows) const {
  const int cells = static_cast<int>(rows.inside.size());
  for (std::size_t g = 0; g < rows.ghosts.size(); ++g) {
    const auto cell = static_cast<std::size_t>(*cell_of_ghost(static_cast<int>(g), cells));
    std::copy_n(rows.inside[cell], rows.components, rows.ghosts[g]);
  }
}

namespace {

/// Returns the share of a continuation that is kept: 1 − x² with x = (s² − d²)²/(s⁴ + d⁴ + e⁴), for the two
/// differences s, d beside a value a and e = a/2. It is 1 − O(Δx¹²) for smooth data, and near 0 if one
/// difference vanishes beside another one that is larger than a. Like the weights of WENO it is a rational
/// function, so that T(u) is smooth and methods keep their order in time.
double share_kept(double s, double d, double a) {
  constexpr double harmless = 0.5;  // relative to the value, of differences that are continued in any case
  const double e = harmless * a, largest = std::max({std::abs(s), std::abs(d), std::abs(e)});
  if (!(largest > 0.0)) return 1.0;  // constant data
  const auto square = [&](double x) { return (x / largest) * (x / largest); };
  const double s2 = square(s), d2 = square(d), e2 = square(e), all = s2 * s2 + d2 * d2 + e2 * e2;
  const double kept = (2.0 * s2 * d2 + e2 * e2) / all;  // 1 − x without cancellation
  return kept * (2.0 - kept);
}

/// The continuation of three cell averages beyond the face.
struct continuation {
  double first, slope, curvature, factor;

  continuation(double a0, double a1, double a2)
      : first(a0), slope(a0 - a1), curvature(a0 - 2.0 * a1 + a2), factor(share_kept(slope, a1 - a2, a0)) {}
  double average(double ghost) const {
    return first + factor * ghost * (slope + 0.5 * (ghost + 1.0) * curvature);
  }
};

}  // namespace

void boundary::incoming(const face&, double, const position&, const double*, double*) const {}

void boundary::incoming_given_outgoing(const face& where, double t, const position& at,
                                       const double* outgoing, std::span<const double* const>,
                                       double* values) const {
  incoming(where, t, at, outgoing, values);
}

std::vector<double> inward_speeds(const face& where, const velocity_set& velocities) {
  std::vector<double> speeds;
  const double sign = where.inward_normal()[static_cast<std::size_t>(where.direction)];
  for (const double v : velocities.speeds(where.direction)) speeds.push_back(sign * v);
  return speeds;
}

std::vector<double> entering_components(const face& where, const velocity_set& velocities) {
  std::vector<double> enters;
  for (const double v : inward_speeds(where, velocities)) enters.push_back(v > 0.0 ? 1.0 : 0.0);
  return enters;
}

void incoming_boundary::fill(const face&, double, const pencil_end& rows) const {
  const auto width = static_cast<std::size_t>(rows.components);
  const std::size_t cells = rows.inside.size();
  const double *a0 = rows.inside[0], *a1 = rows.inside[std::min<std::size_t>(1, cells - 1)],
               *a2 = rows.inside[std::min<std::size_t>(2, cells - 1)];
  for (std::size_t k = 0; k < width; ++k) {
    const continuation beyond(a0[k], a1[k], a2[k]);
    for (std::size_t g = 0; g < rows.ghosts.size(); ++g)
      rows.ghosts[g][k] = beyond.average(static_cast<double>(g + 1));
  }
}

}  // namespace apsis
