#include <apsis/config/case_checks.hpp>

#include <apsis/config/at_place.hpp>
#include <apsis/config/body_reader.hpp>
#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/config/checked_model.hpp>
#include <apsis/config/discretization_of_case.hpp>
#include <apsis/config/force_reader.hpp>
#include <apsis/config/limiter_of_case.hpp>
#include <apsis/config/method_of_case.hpp>
#include <apsis/config/solid_reader.hpp>
#include <apsis/config/steady_of_case.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/model/model.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {

void case_checks::check_together() const {
  check_step_rule();
  if (config_.steady_state.tolerance) check_steady(config_, *checked_model(config_));
  if (has_space(model_)) check_mesh();
  check_epsilon();
  check_fields();
  if (config_.output.units == units_choice::si && !config_.scales)
    refuse(*text_.find("output.units"), "output.units",
           "the scales are those of a gas, and there is no table [gas]",
           "add the table, or write units = \"dimensionless\"");
  const double snapshots = config_.output.every > 0.0 ? config_.time.end / config_.output.every : 0.0;
  if (snapshots > 1e5)
    refuse(*text_.find("output.every"), "output.every",
           fmt::format("that makes {:.3g} snapshots, at most 100000", snapshots), "give a longer interval");
}

void case_checks::check_step_rule() const {
  if (config_.steady_state.tolerance) return;
  std::vector<std::string> given, valid;
  for (const auto& key : step_keys()) {
    if (text_.find(key) != nullptr) given.push_back(key);
    if (has_space(model_) || key == "time.dt") valid.push_back(key);
  }
  if (given.empty())
    throw input_error(
        text_.place_of_missing("time.dt", file_),
        fmt::format("no step size is given ({}{} is needed); add for example {}",
                    valid.size() > 1 ? "one of " : "", fmt::join(valid, ", "), example_of_step()));
  if (given.size() > 1)
    throw input_error(
        text_.find(given[1])->place,
        fmt::format("'{}' conflicts with '{}' (exactly one of {} sets the step); remove all but one",
                    given[1], given[0], fmt::join(valid, ", ")));
  if (config_.time.dt && config_.time.end > 0.0 && *config_.time.dt > config_.time.end * (1.0 + 1e-12))
    refuse(*text_.find("time.dt"), "time.dt",
           fmt::format("it is longer than time.end = {}", config_.time.end),
           "give a step of at most the whole time");
}

/// Returns a step that suits the case: with a limiter the longest one that keeps its promise, else one that
/// most methods take stably.
std::string case_checks::example_of_step() const {
  if (!has_space(model_))
    return fmt::format("dt = {:g}", config_.time.end > 0.0 ? config_.time.end / 100.0 : 0.01);
  const char* const without_limiter = "cfl = 0.5";
  try {
    case_config longest = config_;
    longest.time.safety = 1.0;
    const limiter_choice limiter = text_.find("space.limiter") != nullptr
                                       ? config_.space.limiter
                                       : default_limiter(with_chosen_method(std::move(longest)));
    return limiter == limiter_choice::positivity ? "safety = 1" : without_limiter;
  } catch (const error&) {
    return without_limiter;  // another key is wrong; its message follows when the step is given
  }
}

void case_checks::check_mesh() const {
  check_dimensions();
  check_axis();
  for (std::size_t k = 0; k < config_.space.domain.size(); ++k)
    check_interval(config_.space.domain[k], config_.space.cells[k]);
  check_discretization();
  check_faces();
  if (!config_.solids.empty() || !config_.bodies.empty()) check_solids();
  make_acceleration(config_, *checked_model(config_));
  const int of_line = config_.velocity.points;
  double points = std::max(1, of_line);
  if (config_.is_axisymmetric())
    points *= static_cast<double>(config_.velocity.rings) * config_.velocity.angles;
  for (const int cells : config_.space.cells) points *= cells;
  if (points > 2e9)
    refuse(*text_.find("space.cells"), "space.cells",
           fmt::format("with velocity.points = {} that is {:.3g} unknowns, at most 2e9 are possible", of_line,
                       points),
           "give fewer cells or velocities");
}

void case_checks::check_dimensions() const {
  const auto wanted = static_cast<std::size_t>(checked_model(config_)->space_dimensions());
  const auto check = [&](const std::string& path, std::size_t given, const char* what) {
    if (given == wanted) return;
    const raw_value* raw = text_.find(path);
    throw input_error(
        raw != nullptr ? raw->place : text_.place_of_missing(path, file_),
        fmt::format("'{}' has {} {}{} (model '{}' has {} space dimension{}); give {}", path, given, what,
                    given == 1 ? "" : "s", model_.name, wanted, wanted == 1 ? "" : "s", wanted));
  };
  check("space.cells", config_.space.cells.size(), "number");
  check("space.domain", config_.space.domain.size(), "interval");
  if (config_.space.blocks) check("space.blocks", config_.space.blocks->size(), "number");
  for (std::size_t k = 0; config_.space.blocks && k < wanted; ++k)
    if ((*config_.space.blocks)[k] > config_.space.cells[k])
      refuse(*text_.find("space.blocks"), "space.blocks",
             fmt::format("{} blocks share {} cells", (*config_.space.blocks)[k], config_.space.cells[k]),
             "give at most one block for each cell");
}

void case_checks::check_interval(const interval& ends, int cells) const {
  const auto [lower, upper] = ends;
  const raw_value* raw = text_.find("space.domain");
  const double width = upper - lower;
  if (raw != nullptr && !(width > 0.0))
    throw input_error(raw->place,
                      fmt::format("'space.domain' has the interval [{}, {}] (its lower end is not below its "
                                  "upper end); give the lower end first",
                                  lower, upper));
  const double scale = std::max(std::abs(lower), std::abs(upper));
  if (raw != nullptr && (!std::isfinite(width) || width / cells < 1e-12 * scale))
    refuse(*raw, "space.domain",
           fmt::format("cells of [{}, {}] cannot be told apart in double precision", lower, upper),
           "give a domain nearer to 0 or fewer cells");
}

void case_checks::check_discretization() const {
  const discretization& chosen = discretization_of(config_);
  const auto dimensions = static_cast<int>(config_.space.cells.size());
  if (const std::string why = chosen.why_on_a_line(); dimensions > 1 && !why.empty())
    refuse(*text_.find(discretization_key), discretization_key, why + ": one space dimension only",
           fmt::format("write \"{}\", or leave it out", default_discretization(dimensions).name));
  const auto places = chosen.collision_places();
  if (!config_.space.collisions ||
      std::find(places.begin(), places.end(), *config_.space.collisions) != places.end())
    return;
  const std::string chosen_by = fmt::format("{} = \"{}\"", discretization_key, config_.space.discretization);
  if (places.empty())
    refuse(*text_.find("space.collisions"), "space.collisions",
           fmt::format("{} collide where they are ({})", chosen.unknown().plural(), chosen_by),
           "leave it out");
  refuse(*text_.find("space.collisions"), "space.collisions",
         fmt::format("cells do not collide there ({})", chosen_by),
         suggest(*config_.space.collisions, places));
}

/// Checks the requirements of axisymmetric flow, and refuses its keys in other cases.
void case_checks::check_axis() const {
  if (!config_.is_axisymmetric()) {
    for (const char* path : {"velocity.rings", "velocity.angles", "velocity.max_across"})
      if (const raw_value* raw = text_.find(path); raw != nullptr)
        refuse(*raw, path, "velocities lie on rings in axisymmetric flow alone",
               "write space.geometry = \"axisymmetric\", or remove it");
    return;
  }
  const raw_value& geometry = *text_.find("space.geometry");
  const std::size_t dimensions = config_.space.cells.size();
  if (dimensions > 2)
    refuse(geometry, "space.geometry", "axisymmetric flow has the coordinates (x, r), or r alone",
           "give one or two dimensions");
  if (const double lower = config_.space.domain[dimensions - 1][0]; lower < 0.0)
    refuse(text_.find("space.domain") != nullptr ? *text_.find("space.domain") : geometry, "space.domain",
           fmt::format("it begins at the distance r = {:.6g} from the axis", lower),
           "begin at r = 0 or above");
  if (config_.force.acceleration)
    refuse(geometry, "space.geometry", "forces act along uniform lines of velocities, not on rings",
           "remove the table [force]");
  if (!discretization_of(config_).unknown().pointwise())
    refuse(text_.find(discretization_key) != nullptr ? *text_.find(discretization_key) : geometry,
           discretization_key, "the radius varies within the cell of an average",
           "write \"finite-difference\", or leave it out");
  check_radial_sides();
}

/// Checks that the axis lies at r = 0 only. Cylinders r = const must be neither periodic nor
/// planes of symmetry.
void case_checks::check_radial_sides() const {
  const std::size_t radial = config_.space.cells.size() - 1;
  const auto check = [&](std::size_t face, bool wrong, const char* reason, const char* remedy) {
    if (!wrong) return;
    const std::string kind = fmt::format("boundary.{}.kind", face_names[face]);
    throw input_error(place_of(config_, config_.places.contains(kind) ? kind : "space.boundary"),
                      fmt::format("boundary '{}' is not possible on the side '{}' ({}); {}",
                                  kind_of_face(face), face_names[face], reason, remedy));
  };
  for (std::size_t face = 0; face < 2 * config_.space.cells.size(); ++face) {
    const bool at_axis = face == 2 * radial && config_.space.domain[radial][0] == 0.0;
    const std::string kind = kind_of_face(face);
    check(face, at_axis && kind != "axis", "r = 0 is a line without area", "leave it out, or write \"axis\"");
    check(face, !at_axis && kind == "axis", "the axis is r = 0, at the lower end of r", "choose another");
    check(face, face / 2 == radial && kind == "periodic", "ends in r have different radii",
          "choose a wall or an end");
    check(face, face / 2 == radial && kind == "symmetry", "a cylinder is no plane of symmetry",
          "write kind = \"diffuse\" with accommodation = 0 for specular reflection");
  }
}

const std::string& case_checks::kind_of_face(std::size_t face) const {
  const auto& own = config_.faces[face].kind;
  return own ? *own : config_.space.boundary;
}

void case_checks::check_solids() const {
  make_mesh(config_);
  const auto walls = make_solid_walls(config_, checked_model(config_));
  for (std::size_t k = 0; k < config_.solids.size(); ++k)
    if (walls[k]->periodic())
      throw input_error(place_of(config_, fmt::format("space.solid.{}.kind", k + 1)),
                        "a solid box cannot be periodic (nothing lies behind its faces); give it a wall, "
                        "for example kind = \"diffuse\"");
  for (std::size_t k = 0; k < config_.bodies.size(); ++k) check_body(k, *walls[config_.solids.size() + k]);
  const bool boxes = !config_.solids.empty();
  if (const std::string why = discretization_of(config_).why_without_solids(); !why.empty())
    throw input_error(
        place_of(config_, boxes ? "space.solid.1" : "space.body.1"),
        fmt::format("solid boxes and bodies need point values ({}); write {} = \"finite-difference\"", why,
                    discretization_key));
}

/// Checks that the wall of a body allows any normal, and moves along itself.
void case_checks::check_body(std::size_t k, const boundary& wall) const {
  const std::string path = fmt::format("space.body.{}", k + 1);
  const source_place place = place_of_emitter(config_, path);
  const auto equation = checked_model(config_);
  const auto made = at_place(place, [&] { return wall.oblique(equation->velocities()); });
  if (!made) throw input_error(place, why_no_wall_of_bodies(config_.bodies[k].kind, *equation));
  const grid mesh = make_mesh(config_);
  const int number = static_cast<int>(config_.solids.size() + k);
  for (const wall_segment& piece : mesh.cut()->walls()) {
    if (piece.solid != number) continue;
    at_place(place, [&] { return made->velocity({piece.normal, piece.middle, 0.0}); });
  }
}

void case_checks::check_faces() const {
  const auto sides = make_boundaries(config_, make_model(config_));
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const auto& [lower, upper] = sides[k];
    if (lower->periodic() == upper->periodic()) continue;
    const std::string own = "boundary." + face_names[config_.faces[2 * k].kind ? 2 * k : 2 * k + 1] + ".kind";
    refuse(*text_.find(own), own, "only one of the two ends is periodic",
           "write space.boundary = \"periodic\" alone, or give both ends another kind");
  }
}

// Evaluates epsilon at centres and edges of cells along the diagonal, at about a thousand points or fewer.
// The run checks every cell.
void case_checks::check_epsilon() const {
  const bool on_mesh = has_space(model_);
  const auto dimensions = on_mesh ? config_.space.domain.size() : 0;
  const expression formula = make_epsilon(config_, static_cast<int>(dimensions));
  if (!formula.is_constant() && !on_mesh)
    throw input_error(
        place_of(config_, "model.epsilon"),
        fmt::format("'model.epsilon' depends on x (model '{}' has no space); give a number", model_.name));
  const int points = on_mesh ? std::min(2 * config_.space.cells.front(), 1000) : 0;
  for (int k = 0; k <= points; ++k) {
    position x{};
    for (std::size_t d = 0; d < dimensions; ++d) {
      const auto [lower, upper] = config_.space.domain[d];
      x[d] = points == 0 ? 0.0 : lower + (upper - lower) * k / points;
    }
    formula.evaluate(x);
  }
}

void case_checks::check_fields() const {
  if (config_.output.fields.empty()) return;
  std::vector<std::string> names;
  const auto equation = make_model(config_);
  for (const auto& group : equation->fields())
    for (const auto& field : group.names) names.push_back(field.name);
  for (const auto& name : config_.output.fields)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw input_error(
          text_.find("output.fields")->place,
          fmt::format("unknown field '{}' in 'output.fields' (model '{}' has no such field); {}", shown(name),
                      model_.name, suggest(name, names)));
}

}  // namespace apsis
