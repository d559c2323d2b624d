#include <apsis/boundary/boundary.hpp>

#include <apsis/boundary/continuation_rows.hpp>

#include <algorithm>
#include <cstddef>

namespace apsis {

std::shared_ptr<const boundary> boundary::prepared(const face&, const velocity_set&) const {
  return nullptr;
}

std::shared_ptr<const boundary> boundary::on_surface(const std::function<double()>&) const {
  return nullptr;
}

std::shared_ptr<const oblique_wall> boundary::oblique(const velocity_set&) const {
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

std::array<const double*, 3> three_inside(const pencil_end& rows) {
  const std::size_t cells = rows.inside.size();
  const auto inside = [&](std::size_t cell) { return rows.inside[std::min(cell, cells - 1)]; };
  return {inside(0), inside(1), inside(2)};
}

void incoming_boundary::fill(const face&, double, const pencil_end& rows) const {
  continuation_rows::fill(three_inside(rows), rows.components, rows.ghosts);
}

}  // namespace apsis
