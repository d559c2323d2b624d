#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/discretization_of_case.hpp>
#include <apsis/config/internal/key_of_member.hpp>
#include <apsis/method/family_registry.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/method_choice.hpp>
#include <apsis/method/method_file.hpp>
#include <apsis/method/time_integrator.hpp>
#include <apsis/model/gas_species.hpp>
#include <apsis/model/mean_free_path.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/velocity/velocity_line_registry.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Names of the entries of a registry, as the choices of a key.
template <class Entries>
auto names_in(Entries (*entries)()) {
  return [entries](const case_config&) {
    std::vector<std::string> names;
    for (const auto* entry : entries()) names.push_back(entry->name);
    return names;
  };
}

/// "auto" and the names of all methods.
std::vector<std::string> method_choices(const case_config&) {
  std::vector<std::string> names = integrator_names();
  names.emplace_back(automatic_method);
  return names;
}

std::vector<std::string> initial_choices(const case_config& c) {
  const model_entry* entry = try_find_model(c.model.name);
  return entry != nullptr ? initial_names(*entry) : std::vector<std::string>{};
}

/// A member of a family, or a method file; an invalid file throws with its own place.
std::optional<std::string> check_method_outside_catalogue(const std::string& name) {
  if (is_method_file(name)) {
    static_cast<void>(find_integrator(name));
    return "";
  }
  const family_entry* family = try_find_family(name);
  if (family == nullptr) return std::nullopt;
  return missing_member(*family, name);
}

/// The key, whose value counts as not given where it is 0 or empty.
case_key if_given(case_key of) {
  of.load = [load = std::move(of.load)](const case_config& c) -> case_value {
    case_value value = load(c);
    if (value == case_value(0.0) || value == case_value(std::vector<long>{0}) ||
        value == case_value(std::vector<std::string>{}) ||
        value == case_value(std::vector<std::vector<double>>{}))
      return {};
    return value;
  };
  return of;
}

/// The key, which only an axisymmetric case has.
case_key if_axisymmetric(case_key of) {
  of.load = [load = std::move(of.load)](const case_config& c) -> case_value {
    return c.is_axisymmetric() ? load(c) : case_value{};
  };
  return of;
}

bool needs_max(const std::string& name) {
  const velocity_line_entry* entry = try_find_velocity_line(name);
  return entry != nullptr && entry->needs_max;
}

/// Whether velocity.set is given and no name in it has a property.
bool no_set_is(const case_config& c, bool (*property)(const std::string&)) {
  return !c.velocity.set.empty() && std::none_of(c.velocity.set.begin(), c.velocity.set.end(), property);
}

/// A key from which the resolver derives model.epsilon. A resolved case has it where epsilon depends on x.
case_key derived_key(std::string path, case_key facts) {
  facts.scope = key_scope::velocity;
  facts.store = [](case_config&, const case_value&) {};
  facts.load = [path](const case_config& c) -> case_value {
    const epsilon_formula& given = c.model.epsilon;
    if (path == given.key) return given.text;
    if (path == "model.knudsen.mean_free_path" && !given.mean_free_path.empty()) return given.mean_free_path;
    return {};
  };
  facts.path = std::move(path);
  if (facts.type == key_type::formula) facts.unit = "dimensionless";
  return facts;
}

std::vector<case_key> model_keys() {
  return {key("title", [](auto& c) -> auto& { return c.title; },
              {.doc = "One line that says what the case shows."}),
          key("model.name", [](auto& c) -> auto& { return c.model.name; },
              {.required = true, .choices = names_in(model_entries), .doc = "The equation."}),
          key("model.epsilon", [](auto& c) -> auto& { return c.model.epsilon; },
              {.type = key_type::formula,
               .lowest = 0.0,
               .doc = "Knudsen number (relaxation time): a number, or a formula in the coordinates x, y, z "
                      "as text. 0 is the limit system."}),
          derived_key("model.knudsen",
                      {.doc = "In place of epsilon, for a gas with collision_rate = \"viscosity\": a table "
                              "{value, mean_free_path}, or \"from gas\", the default with a table [gas]."}),
          derived_key("model.knudsen.value",
                      {.type = key_type::formula,
                       .lowest = 0.0,
                       .doc = "Knudsen number lambda/L at rho = T = 1, a number or a formula as epsilon."}),
          derived_key("model.knudsen.mean_free_path",
                      {.choices = [](const case_config&) { return mean_free_path_names(); },
                       .doc = "Definition of lambda (docs/scales.md)."}),
          derived_key("model.rarefaction",
                      {.type = key_type::formula,
                       .lowest = 0.0,
                       .lowest_excluded = true,
                       .doc = "In place of epsilon, for a gas with collision_rate = \"viscosity\": the "
                              "rarefaction parameter delta = p L/(mu sqrt(2 R T)) = 1/(sqrt(2) epsilon) at "
                              "rho = T = 1, a number or a formula as epsilon."}),
          key("model.initial", [](auto& c) -> auto& { return c.model.initial; },
              {.choices = initial_choices,
               .doc = "Name of one of the model's initial data; the first of the model where not given."})};
}

/// A quantity of the table [gas].
template <class At>
case_key gas_quantity(std::string path, At at, dimension dims, const std::string& doc) {
  return key(std::move(path), at,
             {.type = key_type::quantity,
              .scope = key_scope::velocity,
              .unit = unit_of(dims),
              .dimension = dims,
              .doc = doc});
}

std::vector<case_key> gas_keys() {
  return {
      key("gas.name", [](auto& c) -> auto& { return c.gas.name; },
          {.scope = key_scope::velocity,
           .choices = [](const case_config&) { return gas_names(); },
           .doc = "A known gas, whose mass, viscosity, viscosity exponent, Prandtl number and degrees of "
                  "freedom hold unless given. A table [gas] permits units in all quantities of the case, and "
                  "sets the model to this gas."}),
      gas_quantity(
          "gas.mass", [](auto& c) -> auto& { return c.gas.mass; }, dimensions::mass, "Mass of a molecule."),
      gas_quantity(
          "gas.viscosity", [](auto& c) -> auto& { return c.gas.viscosity; }, dimensions::viscosity,
          "Viscosity at gas.viscosity_temperature."),
      gas_quantity(
          "gas.viscosity_temperature", [](auto& c) -> auto& { return c.gas.viscosity_temperature; },
          dimensions::temperature,
          "Temperature of the viscosity; gas.temperature where only gas.viscosity is given."),
      key("gas.viscosity_exponent", [](auto& c) -> auto& { return c.gas.viscosity_exponent; },
          {.scope = key_scope::velocity,
           .lowest = 0.0,
           .highest = 2.0,
           .doc = "Exponent w of the viscosity mu ~ T^w."}),
      key("gas.prandtl", [](auto& c) -> auto& { return c.gas.prandtl; },
          {.scope = key_scope::velocity,
           .lowest = 0.0,
           .lowest_excluded = true,
           .doc = "Prandtl number; that of Eucken's formula, 2/3 of a monatomic gas, where not given."}),
      key("gas.degrees_of_freedom", [](auto& c) -> auto& { return c.gas.degrees_of_freedom; },
          {.scope = key_scope::velocity,
           .lowest = 1,
           .highest = 100,
           .doc = "Degrees of freedom of a molecule; 3 without a name."}),
      gas_quantity(
          "gas.pressure", [](auto& c) -> auto& { return c.gas.pressure; }, dimensions::pressure,
          "Reference pressure. Exactly one of pressure, density and number_density is given."),
      gas_quantity(
          "gas.density", [](auto& c) -> auto& { return c.gas.density; }, dimensions::density,
          "Reference density, in place of the pressure."),
      gas_quantity(
          "gas.number_density", [](auto& c) -> auto& { return c.gas.number_density; },
          dimensions::number_density, "Reference number density, in place of the pressure."),
      gas_quantity(
          "gas.temperature", [](auto& c) -> auto& { return c.gas.temperature; }, dimensions::temperature,
          "Reference temperature, required; in K, or in degC."),
      gas_quantity(
          "gas.length", [](auto& c) -> auto& { return c.gas.length; }, dimensions::length,
          "Reference length, the unit of x; required."),
  };
}

std::vector<case_key> space_keys() {
  return {
      key("space.cells", [](auto& c) -> auto& { return c.space.cells; },
          {.scope = key_scope::space,
           .required = true,
           .lowest = 1,
           .highest = 10'000'000,
           .doc = "Number of cells of equal size; in several dimensions a list, one number for each "
                  "direction."}),
      key("space.domain", [](auto& c) -> auto& { return c.space.domain; },
          {.scope = key_scope::space,
           .dimension = dimensions::length,
           .doc = "Lower and upper end of the domain, [lower, upper] with lower < upper; in several "
                  "dimensions a list of such pairs."}),
      key("space.blocks", [](auto& c) -> auto& { return c.space.blocks; },
          {.scope = key_scope::space,
           .lowest = 1,
           .highest = 10'000'000,
           .doc = "Number of blocks of cells in each direction, one block for each process; by default those "
                  "with the least to send."}),
      key("space.geometry", [](auto& c) -> auto& { return c.space.geometry; },
          {.scope = key_scope::velocity,
           .doc =
               "axisymmetric: nothing depends on the angle about an axis. The last coordinate, y of two or x "
               "of one, is the distance r >= 0 from the axis; velocities are those along x, r and the "
               "angle, in one dimension along r, the angle and the axis. Point values only "
               "(docs/axisymmetric.md)."}),
      key(discretization_key, [](auto& c) -> auto& { return c.space.discretization; },
          {.scope = key_scope::space,
           .choices = [](const case_config&) { return discretization_names(); },
           .doc =
               "Unknowns are cell averages (finite-volume) or point values (finite-difference; about a third "
               "of the cost of cell averages with collisions at Gauss points)."}),
      key("space.collisions", [](auto& c) -> auto& { return c.space.collisions; },
          {.scope = key_scope::space,
           .choices = [](const case_config&) { return collision_place_names(); },
           .doc =
               "Where cell averages collide: gauss: three Gauss points of each cell, on its reconstruction; "
               "centres: values at cell centres that all averages together imply, of fourth order in space, "
               "with a third of the solves. gauss where not given."}),
      key("space.reconstruction", [](auto& c) -> auto& { return c.space.reconstruction; },
          {.scope = key_scope::space,
           .choices = names_in(reconstruction_entries),
           .doc = "Reconstruction scheme."}),
      key("space.limiter", [](auto& c) -> auto& { return c.space.limiter; },
          {.scope = key_scope::space,
           .doc =
               "positivity: limit fluxes so that nonnegative data stay nonnegative for steps up to the "
               "method's SSP coefficient times dx/v_max, at no cost in steps; cell averages with collisions "
               "at Gauss points need their edge values limited, and steps 12 times shorter. Where not given: "
               "positivity where f >= 0 can be kept at no cost in steps, else none."}),
      key("space.boundary", [](auto& c) -> auto& { return c.space.boundary; },
          {.scope = key_scope::space,
           .choices = names_in(boundary_entries),
           .doc = "Boundary condition at every end of the domain (apsis list boundaries). Entropy decay is "
                  "promised for periodic ends only."}),
      key("force.acceleration", [](auto& c) -> auto& { return c.force.acceleration; },
          {.type = key_type::formulas,
           .scope = key_scope::velocity,
           .doc = "Acceleration of the molecules, one formula for each velocity dimension; those that are "
                  "left out are 0."}),
      if_given(key(
          "velocity.set", [](auto& c) -> auto& { return c.velocity.set; },
          {.scope = key_scope::velocity,
           .choices = names_in(velocity_line_entries),
           .doc = "Velocities of each direction, or of all: \"uniform\" where not given, or a file NAME.csv "
                  "or NAME.txt of velocities and weights (relative to where the program runs)."})),
      if_given(key(
          "velocity.max", [](auto& c) -> auto& { return c.velocity.max; },
          {.scope = key_scope::velocity,
           .required = true,
           .optional = [](const case_config& c) { return no_set_is(c, needs_max); },
           .dimension = dimensions::velocity,
           .lowest = 0.0,
           .highest = 1e6,
           .lowest_excluded = true,
           .doc = "Largest velocity: the grid covers [-max, max], which must hold the tails of the data."})),
      if_given(key("velocity.points", [](auto& c) -> auto& { return c.velocity.points; },
                   {.scope = key_scope::velocity,
                    .required = true,
                    .optional =
                        [](const case_config& c) {
                          return no_set_is(c,
                                           [](const std::string& name) { return !is_velocity_file(name); });
                        },
                    .lowest = 4,
                    .highest = 100'000,
                    .doc = "Number of velocities of each direction, or of all."})),
      if_axisymmetric(
          key("velocity.rings", [](auto& c) -> auto& { return c.velocity.rings; },
              {.scope = key_scope::velocity,
               .lowest = 4,
               .highest = 10'000,
               .doc = "Rings of velocities about the axis of axisymmetric flow, up to the largest "
                      "velocity; the set and the points are those along the axis."})),
      if_axisymmetric(key("velocity.angles", [](auto& c) -> auto& { return c.velocity.angles; },
                          {.scope = key_scope::velocity,
                           .lowest = 12,
                           .highest = 10'000,
                           .doc = "Velocities on each ring, a multiple of 4."})),
      if_axisymmetric(key("velocity.max_across", [](auto& c) -> auto& { return c.velocity.max_across; },
                          {.scope = key_scope::velocity,
                           .dimension = dimensions::velocity,
                           .lowest = 0.0,
                           .highest = 1e6,
                           .lowest_excluded = true,
                           .doc = "Largest velocity of the rings; velocity.max where not given."})),
      key("velocity.equilibrium", [](auto& c) -> auto& { return c.velocity.equilibrium; },
          {.scope = key_scope::velocity,
           .doc = "Maxwellian by its formula, or with the discrete moments matched (conservative on any "
                  "grid); auto measures which is needed."})};
}

/// The kinds of the faces; the other keys of their tables are variables of the kinds.
std::vector<case_key> face_keys() {
  std::vector<case_key> all;
  for (std::size_t k = 0; k < face_names.size(); ++k)
    all.push_back(
        key("boundary." + face_names[k] + ".kind", [k](auto& c) -> auto& { return c.faces[k].kind; },
            {.scope = key_scope::space,
             .choices = names_in(boundary_entries),
             .doc = fmt::format(
                 "Boundary condition at the {} end in {}, where it differs from "
                 "space.boundary. Further keys of the table [boundary.{}] are the variables "
                 "of the kind (apsis list boundaries): numbers, formulas in t and x, or tables in time, "
                 "T = {{ file = \"wall.csv\" }} with columns t and T. profile = {{ file = "
                 "\"results/earlier/solution.h5\", side = \"right\" }} gives rho, u and T of a side "
                 "of an earlier result.",
                 k % 2 == 0 ? "lower" : "upper", "xyz"[k / 2], face_names[k])}));
  return all;
}

/// Whether the run finds the steady state.
bool is_steady(const case_config& c) {
  return c.steady_state.tolerance.has_value();
}

/// The key, which only a case with a table [steady] has.
case_key if_steady(case_key of) {
  of.load = [load = std::move(of.load)](const case_config& c) -> case_value {
    return is_steady(c) ? load(c) : case_value{};
  };
  return of;
}

std::vector<case_key> steady_keys() {
  return {
      if_steady(key(
          "steady.tolerance", [](auto& c) -> auto& { return c.steady_state.tolerance; },
          {.scope = key_scope::space,
           .lowest = 1e-14,
           .highest = 1e-2,
           .doc = "The run finds the steady state by iterations in place of steps in time, up to this "
                  "residual relative to that of the initial data, and this relative change of the moments. "
                  "Initial data give the start and the mass between walls. The table [time] is not used: t "
                  "counts iterations."})),
      if_steady(key("steady.iterations", [](auto& c) -> auto& { return c.steady_state.iterations; },
                    {.scope = key_scope::space,
                     .lowest = 1,
                     .highest = 1'000'000,
                     .doc = "Most iterations; a run that needs more ends with exit code 3."})),
      if_steady(key(
          "steady.images", [](auto& c) -> auto& { return c.steady_state.images; },
          {.scope = key_scope::space,
           .lowest = 0,
           .highest = 20,
           .doc = "Earlier iterates from which each one is mixed (Anderson), one copy of the state each and "
                  "one more; 0: none."}))};
}

std::vector<case_key> time_keys() {
  return {
      key("time.method", [](auto& c) -> auto& { return c.time.method; },
          {.choices = method_choices,
           .doc = "The time integrator. auto: chosen by the kind of problem, the tolerance, bounds to "
                  "preserve and C dt/epsilon (apsis list choices); the first line of the log states it. "
                  "Otherwise its name in the catalogue, a multistep method for equal steps (apsis list "
                  "multistep), a member of a family (apsis list families) such as md-imex-chain-7-2, or "
                  "a method file of yours (FILE.toml, relative to where the program runs).",
           .also = check_method_outside_catalogue}),
      key("time.end", [](auto& c) -> auto& { return c.time.end; },
          {.required = true,
           .optional = is_steady,
           .dimension = dimensions::time,
           .lowest = 0.0,
           .doc = "Final time; the start is t = 0."}),
      key("time.dt", [](auto& c) -> auto& { return c.time.dt; },
          {.dimension = dimensions::time,
           .lowest = 0.0,
           .lowest_excluded = true,
           .doc = "Step size. Exactly one of dt, cfl and safety is given."}),
      key("time.cfl", [](auto& c) -> auto& { return c.time.cfl; },
          {.scope = key_scope::space,
           .lowest = 0.0,
           .lowest_excluded = true,
           .doc = "Step size as dt = cfl * dx / v_max, in several dimensions cfl / sum_k (v_max,k / "
                  "dx_k). Exactly "
                  "one of dt, cfl and safety is given."}),
      key("time.safety", [](auto& c) -> auto& { return c.time.safety; },
          {.scope = key_scope::space,
           .lowest = 0.0,
           .lowest_excluded = true,
           .doc = "Step size as dt = safety * r * dt_FE with the SSP coefficient r of the method and the "
                  "forward Euler step dt_FE of the transport; positivity is guaranteed up to 1. r dt_FE is "
                  "at most the linear stability limit of the method with the reconstruction "
                  "(apsis check). Exactly one of dt, cfl and safety is given."}),
      key("time.startup", [](auto& c) -> auto& { return c.time.startup; },
          {.doc = "graded: the first step is split into steps that double, starting with a quarter of "
                  "the smallest epsilon/C, so that the initial layer of data out of equilibrium is "
                  "resolved; for methods whose layer is not 1 (apsis check). About log2(4 C dt/epsilon) "
                  "more steps, none for epsilon = 0."}),
      key("time.startup_growth", [](auto& c) -> auto& { return c.time.startup_growth; },
          {.lowest = 2,
           .highest = largest_growth,
           .doc = "Ratio g of the times of a graded start, whose first step is at most g/8 of the "
                  "smallest epsilon/C and each further one g - 1 times the time before it. 4 or 8 takes "
                  "half or a third of the steps with 10 to 100 times the error of the layer, which is "
                  "small for methods of order 5 and more."}),
      key("time.tolerance", [](auto& c) -> auto& { return c.time.tolerance; },
          {.lowest = 0.0,
           .lowest_excluded = true,
           .doc = "Tolerance on the estimated error of each step, which is the 2-norm of the difference "
                  "to the method's embedded solution relative to that of the state; errors off "
                  "equilibrium, which relax, count less in steps shorter than the tolerance asks for "
                  "(docs/methods.md). dt, cfl or safety then limits the step; startup = graded starts in "
                  "the initial layer. Methods without an embedded solution (apsis list methods) compare "
                  "two steps "
                  "of half the length with one instead, and continue with the two."}),
      key("time.steady", [](auto& c) -> auto& { return c.time.steady; },
          {.dimension = dimensions::none / dimensions::time,
           .lowest = 0.0,
           .lowest_excluded = true,
           .doc =
               "The run ends as soon as the state is steady: its change per unit of time, relative to "
               "its 2-norm, is at most this; time.end is then the latest end. The distance from the steady "
               "state is this rate times the time in which it decays, which the summary estimates."})};
}

std::vector<case_key> output_keys() {
  return {
      key("output.every", [](auto& c) -> auto& { return c.output.every; },
          {.dimension = dimensions::time,
           .lowest = 0.0,
           .doc = "Time between snapshots of the fields; 0 keeps the final state only."}),
      key("output.fields", [](auto& c) -> auto& { return c.output.fields; },
          {.doc =
               "Names of the macroscopic fields to write; empty writes the usual ones of the model, of a gas "
               "rho, u, T, stress, heat_flux (with several velocity dimensions u_x, stress_xy, heat_flux_x, "
               "...). Further fields of a gas: p, mach, distance (to equilibrium), knudsen (local Knudsen "
               "number), divergence and vorticity of u (vorticity_x, ... with three velocity dimensions)."}),
      key("output.units", [](auto& c) -> auto& { return c.output.units; },
          {.scope = key_scope::velocity,
           .doc = "Units of fields, history and report: dimensionless, or those of the SI, with a table "
                  "[gas]. The distribution f, its velocities and checkpoints are dimensionless."}),
      key("output.distribution", [](auto& c) -> auto& { return c.output.distribution; },
          {.doc = "Where the unknowns themselves (f) are written: nowhere, at the end into solution.h5, or "
                  "also for every snapshot, into files of their own in snapshots/."}),
      if_given(key("output.distribution_at", [](auto& c) -> auto& { return c.output.distribution_at; },
                   {.scope = key_scope::space,
                    .dimension = dimensions::length,
                    .doc = "Points [[x, y], ...]: f is written in the cells that contain them, as points/f "
                           "of the file, and not in all cells."})),
      key("output.surfaces", [](auto& c) -> auto& { return c.output.surfaces; },
          {.scope = key_scope::space,
           .doc = "Names of faces (left, right, bottom, ...) that are not periodic and of solid boxes, or "
                  "\"all\": what the gas gives to them in the last step, of mass, momentum and energy per "
                  "unit of time and area, with pressure, shear stress and heat flux, at every cell face, in "
                  "surfaces/NAME.csv."}),
      key("output.stride", [](auto& c) -> auto& { return c.output.stride; },
          {.unit = "cells",
           .lowest = 1,
           .highest = 10'000'000,
           .doc =
               "Snapshots of f contain every stride-th cell in each direction, beginning with the first."}),
      key("output.precision", [](auto& c) -> auto& { return c.output.precision; },
          {.doc = "Precision of snapshots of f. In single precision numbers have 7 digits and are 0 below "
                  "1e-45. The end and checkpoints have every digit."}),
      key("output.checkpoint_every", [](auto& c) -> auto& { return c.output.checkpoint_every; },
          {.unit = "steps",
           .lowest = 0,
           .highest = 1'000'000'000,
           .doc =
               "Steps between checkpoints; 0 writes none by steps. An interrupted run always leaves one."}),
      key("output.checkpoint_minutes", [](auto& c) -> auto& { return c.output.checkpoint_minutes; },
          {.unit = "minutes",
           .lowest = 0.0,
           .doc = "Minutes of wall time between checkpoints; 0 writes none by time."}),
      key("output.history_rows", [](auto& c) -> auto& { return c.output.history_rows; },
          {.unit = "rows",
           .lowest = 100,
           .highest = 10'000'000,
           .doc = "Most rows of the history. A run of more steps keeps every 2nd, 4th, 8th, … step, the last "
                  "one, and the steps at which a column is smallest or largest."})};
}

}  // namespace

const std::vector<case_key>& case_schema() {
  static const std::vector<case_key> schema = [] {
    std::vector<case_key> all;
    for (auto* group : {model_keys, gas_keys, space_keys, face_keys, steady_keys, time_keys, output_keys})
      for (case_key& one : group()) all.push_back(std::move(one));
    return all;
  }();
  return schema;
}

}  // namespace apsis
