#include <apsis/config/emitted_values.hpp>

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/mesh/cut_cells.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Returns the points of a box at the ends, middles and quarters of its sides. `flat` is a
/// direction without extent.
std::vector<position> points_of_box(const std::vector<std::array<double, 2>>& sides, int flat) {
  constexpr int parts = 4;
  std::vector<position> points = {position{}};
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const auto [lower, upper] = sides[k];
    std::vector<position> more;
    for (position x : points)
      for (int part = 0; part <= (static_cast<int>(k) == flat ? 0 : parts); ++part) {
        x[k] = lower + (upper - lower) * part / parts;
        more.push_back(x);
      }
    points = std::move(more);
  }
  return points;
}

std::vector<position> points_of_face(const case_config& config, const face& where) {
  auto sides = config.space.domain;
  auto& normal = sides[static_cast<std::size_t>(where.direction)];
  if (where.upper) normal[0] = normal[1];
  return points_of_box(sides, where.direction);
}

/// Returns the middles of about a hundred wall segments of a body, or of all if there are fewer.
std::vector<position> points_of_body(const case_config& config, std::size_t body) {
  constexpr std::size_t most = 100;
  std::vector<position> points;
  const grid mesh = make_mesh(config);
  for (const wall_segment& one : mesh.cut()->walls())
    if (one.solid == static_cast<int>(mesh.solids().size() + body)) points.push_back(one.middle);
  std::vector<position> some;
  for (std::size_t k = 0; k < points.size(); k += std::max<std::size_t>(1, points.size() / most))
    some.push_back(points[k]);
  return some;
}

/// Returns the moments of functions of the velocity at all velocities.
std::array<double, 5> moments_of(const emitted_values& values, const gas& molecules, double t,
                                 const position& x) {
  const velocity_set& velocities = molecules.velocities();
  const auto n = static_cast<std::size_t>(velocities.size());
  std::vector<double> row(static_cast<std::size_t>(velocities.components()));
  const std::vector<std::string> names =
      molecules.reduced() ? std::vector<std::string>{"g", "h"} : std::vector<std::string>{"f"};
  for (std::size_t set = 0; set < names.size(); ++set)
    for (std::size_t j = 0; j < n; ++j) {
      position v{};
      for (int k = 0; k < velocities.dimensions(); ++k)
        v[static_cast<std::size_t>(k)] = velocities.speeds(k)[j];
      row[set * n + j] = values.at(names[set], 0, t, x, v);
    }
  std::array<double, 5> omega{};
  molecules.moments(row.data(), 0, 1, omega.data());
  return omega;
}

}  // namespace

std::vector<emitter> emitters_of(const case_config& config) {
  std::vector<emitter> all;
  for (std::size_t k = 0; k < 2 * config.space.cells.size(); ++k)
    all.push_back({"boundary." + std::string(face_names[k]),
                   config.faces[k].kind.value_or(config.space.boundary), &config.faces[k].values,
                   points_of_face(config, face_of(k))});
  for (std::size_t k = 0; k < config.solids.size(); ++k) {
    const solid_table& solid = config.solids[k];
    std::vector<std::array<double, 2>> sides;
    for (std::size_t d = 0; d < solid.from.size(); ++d) sides.push_back({solid.from[d], solid.to[d]});
    all.push_back(
        {fmt::format("space.solid.{}", k + 1), solid.kind, &solid.values, points_of_box(sides, -1)});
  }
  for (std::size_t k = 0; k < config.bodies.size(); ++k)
    all.push_back({fmt::format("space.body.{}", k + 1), config.bodies[k].kind, &config.bodies[k].values,
                   points_of_body(config, k)});
  return all;
}

emitted_values::emitted_values(const case_config& config, const model& equation, const emitter& of) {
  const boundary_entry& entry = find_boundary(of.kind);
  if (entry.variables == nullptr) return;
  for (const data_variable& variable : entry.variables(equation)) {
    value one{variable.value.value_or(0.0), {}};
    if (const auto found = of.given->find(variable.name); found != of.given->end())
      for (const auto& text : found->second)
        one.formulas.emplace_back(text, source_place{}, config.constants, equation.space_dimensions(),
                                  variable.of_velocity ? equation.velocities().dimensions() : 0);
    all_.emplace(variable.name, std::move(one));
  }
}

bool emitted_values::steady() const {
  return std::all_of(all_.begin(), all_.end(), [](const auto& one) {
    return std::all_of(one.second.formulas.begin(), one.second.formulas.end(),
                       [](const auto& formula) { return formula.is_steady(); });
  });
}

double emitted_values::at(const std::string& name, std::size_t k, double t, const position& x,
                          const position& v) const {
  const value& of = all_.at(name);
  return k < of.formulas.size() ? of.formulas[k].at(t, x, v) : of.standard;
}

fluid_state emitted_values::state(const gas& molecules, double t, const position& x) const {
  if (by_functions()) return molecules.state(moments_of(*this, molecules, t, x).data());
  fluid_state state;
  state.rho = has("rho") ? at("rho", 0, t, x) : 1.0;
  state.T = at("T", 0, t, x);
  for (const char* name : {"u", "velocity"})
    for (std::size_t k = 0; has(name) && k < static_cast<std::size_t>(molecules.dimensions()); ++k)
      state.u[k] = at(name, k, t, x);
  return state;
}

}  // namespace apsis
