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
struct outgoing_continuation {
  double first, slope, curvature, factor;

  outgoing_continuation(double a0, double a1, double a2)
      : first(a0),
        slope(a0 - a1),
        curvature(a0 - 2.0 * a1 + a2),
        factor(limited(slope + curvature, slope, a1 - a2)) {}
  double at_face() const { return first + factor * (0.5 * slope + curvature / 3.0); }
  double average(double ghost) const {
    return first + factor * ghost * (slope + 0.5 * (ghost + 1.0) * curvature);
  }
};

/// The continuation of the value at the face and two cell averages beyond the face, from b x + c x² with the
/// width of a cell as unit of length.
struct incoming_continuation {
  double value, b, c, factor;

  incoming_continuation(double w, double a0, double a1) : value(w) {
    const double near = a0 - w, far = a1 - w;
    c = 0.75 * (far - 3.0 * near);
    b = 0.5 * (7.0 * near - far);
    factor = limited(2.0 * change(1.0), 2.0 * near, a1 - a0);
  }
  double change(double ghost) const { return b * (0.5 - ghost) + c * (1.0 / 3.0 - ghost + ghost * ghost); }
  double average(double ghost) const { return value + factor * change(ghost); }
};

}  // namespace

void boundary::incoming(const face&, double, const position&, const double*, double*) const {}

std::vector<double> entering_components(const face& where, const velocity_set& velocities) {
  std::vector<double> enters;
  for (const double v : velocities.speeds(where.direction))
    enters.push_back((where.upper ? v < 0.0 : v > 0.0) ? 1.0 : 0.0);
  return enters;
}

void incoming_boundary::fill(const face& where, double t, const pencil_end& rows) const {
  const auto width = static_cast<std::size_t>(rows.components);
  const std::size_t cells = rows.inside.size();
  const double *a0 = rows.inside[0], *a1 = rows.inside[std::min<std::size_t>(1, cells - 1)],
               *a2 = rows.inside[std::min<std::size_t>(2, cells - 1)];
  const std::vector<double> enters = entering_components(where, rows.velocities);
  std::vector<double> leaving(width), entering(width);
  for (std::size_t k = 0; k < width; ++k) {
    if (enters[k] != 0.0) continue;
    const double value = outgoing_continuation(a0[k], a1[k], a2[k]).at_face();
    // The continuation of nonnegative values may be negative.
    leaving[k] = std::min({a0[k], a1[k], a2[k]}) >= 0.0 ? std::max(value, 0.0) : value;
  }
  incoming(where, t, rows.at, leaving.data(), entering.data());
  for (std::size_t g = 0; g < rows.ghosts.size(); ++g) {
    const double ghost = static_cast<double>(g + 1);
    for (std::size_t k = 0; k < width; ++k)
      rows.ghosts[g][k] = enters[k] != 0.0 ? incoming_continuation(entering[k], a0[k], a1[k]).average(ghost)
                                           : outgoing_continuation(a0[k], a1[k], a2[k]).average(ghost);
  }
}

}  // namespace apsis
