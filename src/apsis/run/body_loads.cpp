#include <apsis/run/body_loads.hpp>

#include <apsis/core/index.hpp>
#include <apsis/run/internal/surface_columns.hpp>
#include <apsis/run/obstacle_extents.hpp>
#include <apsis/run/result_units.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

using list = std::vector<double>;

double product(const list& a, const list& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Returns a × b; in the plane, its component along z.
list cross(const list& a, const list& b) {
  if (a.size() == 2) return {a[0] * b[1] - a[1] * b[0]};
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Returns body_load::mirrors of every solid box and body, in the order of grid::solid().
std::vector<std::vector<int>> mirrors_of_obstacles(const run_setup& setup) {
  const case_config& config = setup.config();
  std::vector<std::vector<int>> all;
  for (const obstacle_extent& one : measure_obstacles(setup.whole_mesh()).obstacles) {
    std::vector<int>& mirrors = all.emplace_back();
    for (int k = 0; k < setup.whole_mesh().dimensions() && !setup.whole_mesh().has_axis(); ++k)
      for (const bool upper : {false, true}) {
        const std::size_t side = face{k, upper}.index();
        const bool mirrored = config.faces[side].kind.value_or(config.space.boundary) == "symmetry";
        if (mirrored && one.touches[side] && (mirrors.empty() || mirrors.back() != k)) mirrors.push_back(k);
      }
  }
  return all;
}

/// Returns whether a force vanishes for a symmetric body.
bool vanishes(const list& direction, const std::vector<int>& mirrors) {
  constexpr double rounding = 1e-12;
  return std::any_of(mirrors.begin(), mirrors.end(),
                     [&](int k) { return std::abs(direction[at(k)]) > rounding; });
}

/// Returns whether component `k` of a torque vanishes for a symmetric body; in the plane, that along z. A
/// mirror turns components of a torque along itself.
bool torque_vanishes(std::size_t k, const body_load& body) {
  const bool in_plane = body.force.size() == 2;
  return std::any_of(body.mirrors.begin(), body.mirrors.end(),
                     [&](int mirror) { return in_plane || at(mirror) != k; });
}

/// Returns "moment" in the plane; "moment_x", "moment_y" and "moment_z" in space.
std::vector<std::string> names_of_torque(const std::string& head, int dimensions) {
  if (dimensions == 2) return {head};
  return {head + "_x", head + "_y", head + "_z"};
}

/// Reads the load of a body from the columns of a history.
class load_reader {
 public:
  load_reader(const run_setup& setup, const loaded_body& body, const std::vector<std::string>& columns,
              std::vector<int> mirrors)
      : name_(body.name), about_axis_(setup.whole_mesh().has_axis()), mirrors_(std::move(mirrors)) {
    const auto place = [&](const std::string& column) { return place_of_name(columns, column).value(); };
    const auto invariants = setup.equation->invariants();
    const auto momenta = places_of_momenta(*setup.equation);
    const int dimensions = setup.whole_mesh().dimensions();
    for (int k = 0; k < dimensions; ++k)
      force_.push_back(place(fmt::format("flux_{}_{}", name_, invariants[momenta[at(k)]])));
    for (const auto& column : names_of_torque("torque_" + name_, dimensions))
      torque_.push_back(place(column));
    heat_ = place(fmt::format("flux_{}_energy", name_));
  }

  body_load load(const list& row) const {
    body_load made{name_, {}, {}, 0.0 - row[heat_], mirrors_};
    for (const std::size_t k : force_) made.force.push_back(0.0 - row[k]);
    if (about_axis_) made.force[1] = 0.0;
    for (const std::size_t k : torque_) made.torque.push_back(row[k]);
    return made;
  }

 private:
  std::string name_;
  bool about_axis_;           ///< radial forces on a ring cancel
  std::vector<int> mirrors_;  ///< of body_load
  std::vector<std::size_t> force_, torque_;
  std::size_t heat_ = 0;
};

}  // namespace

std::vector<loaded_body> loaded_bodies(const run_setup& setup) {
  std::vector<loaded_body> all;
  if (!setup.has_space()) return all;
  const int dimensions = setup.whole_mesh().dimensions();
  if (dimensions < 2 || places_of_momenta(*setup.equation).size() < at(dimensions) ||
      !place_of_name(setup.equation->invariants(), "energy"))
    return all;
  const auto names = setup.open_faces();
  const auto& surfaces = setup.builder().space().budget_surfaces();
  for (std::size_t k = 0; k < surfaces.size(); ++k)
    if (surfaces[k].solid >= 0) all.push_back({names[k], k, at(surfaces[k].solid)});
  return all;
}

std::vector<body_load> body_loads(const run_setup& setup, const step_record& step) {
  std::vector<body_load> all;
  const auto invariants = setup.equation->invariants();
  const auto momenta = places_of_momenta(*setup.equation);
  const auto bodies = loaded_bodies(setup);
  if (bodies.empty()) return all;
  const auto mirrors = mirrors_of_obstacles(setup);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto flux = [&](std::size_t invariant) {
      return 0.0 - step.flux[bodies[b].face * invariants.size() + invariant];
    };
    body_load& made = all.emplace_back();
    made.name = bodies[b].name;
    for (int k = 0; k < setup.whole_mesh().dimensions(); ++k) made.force.push_back(flux(momenta[at(k)]));
    if (setup.whole_mesh().has_axis()) made.force[1] = 0.0;  // radial forces on a ring cancel
    const std::size_t count = step.torque.size() / bodies.size();
    const auto first = step.torque.begin() + static_cast<std::ptrdiff_t>(b * count);
    made.torque.assign(first, first + static_cast<std::ptrdiff_t>(count));
    made.heat = flux(place_of_name(invariants, "energy").value());
    made.mirrors = mirrors[bodies[b].obstacle];
  }
  return all;
}

std::vector<load_value> loads_in_stream(const body_load& body, const reference_values& stream) {
  const int dimensions = static_cast<int>(stream.velocity.size());
  const double speed = stream.speed(), unit = stream.dynamic_pressure() * stream.size();
  dimension force = dimensions::pressure;
  for (int k = 1; k < dimensions + (stream.about_axis ? 1 : 0); ++k) force = force * dimensions::length;
  std::vector<load_value> loads, coefficients;
  const auto add = [&](const std::string& name, const std::string& coefficient, double value,
                       const dimension& dims, double of_one, bool is_torque = false) {
    loads.push_back({name, value, dims, is_torque});
    coefficients.push_back({coefficient, value / of_one, dimensions::none});
  };
  add("drag", "C_D", product(body.force, stream.velocity) / speed, force, unit);
  if (const list across = stream.lift_direction(); !across.empty() && !vanishes(across, body.mirrors))
    add("lift", "C_L", product(body.force, across), force, unit);
  const list of_centre = stream.about_axis ? list{0.0} : cross(stream.centre, body.force);
  const auto moments = names_of_torque("moment", dimensions), names = names_of_torque("C_M", dimensions);
  for (std::size_t k = 0; k < moments.size(); ++k)
    if (!torque_vanishes(k, body))
      add(moments[k], names[k], body.torque[k] - of_centre[k], force * dimensions::length,
          unit * stream.length, true);
  add("heat", "C_H", body.heat, force * dimensions::velocity, unit * speed);
  loads.insert(loads.end(), coefficients.begin(), coefficients.end());
  return loads;
}

std::vector<std::string> torque_columns(const run_setup& setup) {
  std::vector<std::string> columns;
  for (const loaded_body& body : loaded_bodies(setup))
    for (auto& name : names_of_torque("torque_" + body.name, setup.whole_mesh().dimensions()))
      columns.push_back(std::move(name));
  return columns;
}

namespace {

/// Returns a column name such as "C_D_NAME" or "moment_NAME_x".
std::string column_of(const std::string& load, const std::string& body) {
  const bool component = load.size() > 2 && load[load.size() - 2] == '_' && std::islower(load.back()) != 0;
  if (!component) return fmt::format("{}_{}", load, body);
  return fmt::format("{}_{}_{}", load.substr(0, load.size() - 2), body, load.back());
}

}  // namespace

std::vector<history_unit> load_units(const simulation& run) {
  const run_setup& setup = run.setup();
  std::vector<history_unit> all;
  dimension torque = dimensions::pressure;
  if (!setup.has_space()) return all;
  for (int k = 0; k < setup.whole_mesh().dimensions_of_integrals(); ++k) torque = torque * dimensions::length;
  const int lacking = lacking_directions(setup.whole_mesh());
  for (auto& name : torque_columns(setup)) all.push_back({std::move(name), torque, unit_of_torque(lacking)});
  const auto& reference = run.config().output.reference;
  if (!reference) return all;
  for (const body_load& body : body_loads(setup, run.last()))
    for (const load_value& one : loads_in_stream(body, *reference))
      if (one.dims != dimensions::none)
        all.push_back({column_of(one.name, body.name), one.dims,
                       one.is_torque ? unit_of_torque(lacking) : unit_of_amount(one.dims, lacking)});
  return all;
}

numeric_table with_loads(numeric_table history, const simulation& run) {
  const auto& reference = run.config().output.reference;
  if (!reference) return history;
  const std::vector<std::string> columns = history.columns;
  const auto bodies = loaded_bodies(run.setup());
  const auto mirrors = bodies.empty() ? std::vector<std::vector<int>>{} : mirrors_of_obstacles(run.setup());
  for (const loaded_body& body : bodies) {
    const load_reader reader(run.setup(), body, columns, mirrors[body.obstacle]);
    for (std::size_t k = 0; k < history.rows.size(); ++k)
      for (const load_value& one : loads_in_stream(reader.load(history.rows[k]), *reference)) {
        if (k == 0) history.columns.push_back(column_of(one.name, body.name));
        history.rows[k].push_back(one.value);
      }
  }
  return history;
}

}  // namespace apsis
