#include <apsis/config/case_schema.hpp>

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/method/family_registry.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/method_file.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

std::vector<std::string> model_choices(const case_config&) {
  std::vector<std::string> names;
  for (const model_entry* entry : model_entries()) names.push_back(entry->name);
  return names;
}

std::vector<std::string> initial_choices(const case_config& c) {
  const model_entry* entry = find_model(c.model.name);
  return entry != nullptr ? initial_names(*entry) : std::vector<std::string>{};
}

std::vector<std::string> reconstruction_choices(const case_config&) {
  std::vector<std::string> names;
  for (const reconstruction_entry* entry : reconstruction_entries()) names.push_back(entry->name);
  return names;
}

std::vector<std::string> method_choices(const case_config&) {
  return method_names();
}

/// A member of a family, or a method file; a file that is no good throws with its own place.
std::optional<std::string> method_besides(const std::string& name) {
  if (is_method_file(name)) {
    find_method(name);
    return "";
  }
  const family_entry* family = find_family(name);
  if (family == nullptr) return std::nullopt;
  return missing_member(*family, name);
}

case_value optional_number(const std::optional<double>& x) {
  return x ? case_value(*x) : case_value();
}

case_value optional_text(const std::optional<std::string>& text) {
  return text ? case_value(*text) : case_value();
}

const char* formulation_name(formulation f) {
  return f == formulation::finite_volume ? "finite-volume" : "finite-difference";
}

std::vector<std::string> formulation_choices(const case_config&) {
  return {formulation_name(formulation::finite_volume), formulation_name(formulation::finite_difference)};
}
std::vector<std::string> limiter_choices(const case_config&) {
  return {"none", "positivity"};
}
std::vector<std::string> boundary_choices(const case_config&) {
  return boundary_names();
}
std::vector<std::string> equilibrium_choices(const case_config&) {
  return {"auto", "formula", "discrete"};
}
std::vector<std::string> startup_choices(const case_config&) {
  return {"none", "graded"};
}
std::vector<std::string> distribution_choices(const case_config&) {
  return {"none", "end", "snapshots"};
}
std::vector<std::string> precision_choices(const case_config&) {
  return {"double", "single"};
}

const std::string& text_of(const case_value& v) {
  return std::get<std::string>(v);
}
double number_of(const case_value& v) {
  return std::get<double>(v);
}
int integer_of(const case_value& v) {
  return static_cast<int>(std::get<long>(v));
}

std::vector<case_key> make_schema() {
  using c = case_config;
  using v = case_value;
  const auto text = key_type::text;
  const auto number = key_type::number;
  const auto integer = key_type::integer;
  const std::string none = "dimensionless";
  return {
      {"title", text, key_scope::always, false, "", 0, 0, false, nullptr,
       "One line that says what the case shows.", [](c& o, const v& x) { o.title = text_of(x); },
       [](const c& o) { return v(o.title); }},
      {"model.name", text, key_scope::always, true, "", 0, 0, false, model_choices, "The equation.",
       [](c& o, const v& x) { o.model.name = text_of(x); }, [](const c& o) { return v(o.model.name); }},
      {"model.epsilon", key_type::formula, key_scope::always, false, none, 0, unlimited, false, nullptr,
       "Knudsen number (relaxation time): a number, or a formula in x as text. 0 is the limit system.",
       [](c& o, const v& x) { o.model.epsilon = text_of(x); }, [](const c& o) { return v(o.model.epsilon); }},
      {"model.initial", text, key_scope::always, false, "", 0, 0, false, initial_choices,
       "Name of one of the model's initial data; the first of the model where not given.",
       [](c& o, const v& x) { o.model.initial = text_of(x); }, [](const c& o) { return v(o.model.initial); }},
      {"space.cells", integer, key_scope::space, true, none, 1, 10'000'000, false, nullptr,
       "Number of cells of equal size.", [](c& o, const v& x) { o.space.cells = integer_of(x); },
       [](const c& o) { return v(long{o.space.cells}); }},
      {"space.domain", key_type::number_pair, key_scope::space, false, none, -unlimited, unlimited, false,
       nullptr, "Left and right end of the domain, [left, right] with left < right.",
       [](c& o, const v& x) { o.space.domain = std::get<std::array<double, 2>>(x); },
       [](const c& o) { return v(o.space.domain); }},
      {"space.formulation", text, key_scope::space, false, "", 0, 0, false, formulation_choices,
       "Unknowns are cell averages (finite-volume; collisions at Gauss points of the cell) or point values "
       "(finite-difference; collisions pointwise, about a third of the cost).",
       [](c& o, const v& x) {
         o.space.formulation = text_of(x) == formulation_name(formulation::finite_volume)
                                   ? formulation::finite_volume
                                   : formulation::finite_difference;
       },
       [](const c& o) { return v(std::string(formulation_name(o.space.formulation))); }},
      {"space.reconstruction", text, key_scope::space, false, "", 0, 0, false, reconstruction_choices,
       "How values at cell edges are made from the cells.",
       [](c& o, const v& x) { o.space.reconstruction = text_of(x); },
       [](const c& o) { return v(o.space.reconstruction); }},
      {"space.limiter", text, key_scope::space, false, "", 0, 0, false, limiter_choices,
       "positivity: scale the reconstruction of each cell towards its average so that nonnegative data stay "
       "nonnegative for steps up to the method's SSP coefficient times dx/(12 v_max).",
       [](c& o, const v& x) { o.space.limiter = text_of(x); }, [](const c& o) { return v(o.space.limiter); }},
      {"space.boundary", text, key_scope::space, false, "", 0, 0, false, boundary_choices,
       "What lies beyond the ends of the domain: its other end (periodic), or a copy of the last cell inside "
       "(outflow; conservation and entropy decay are then not promised).",
       [](c& o, const v& x) { o.space.boundary = text_of(x); },
       [](const c& o) { return v(o.space.boundary); }},
      {"boundary.left.kind", text, key_scope::space, false, "", 0, 0, false, boundary_choices,
       "What lies beyond the left end, where it differs from space.boundary. Table [boundary.left].",
       [](c& o, const v& x) { o.faces.left = text_of(x); },
       [](const c& o) { return optional_text(o.faces.left); }},
      {"boundary.right.kind", text, key_scope::space, false, "", 0, 0, false, boundary_choices,
       "What lies beyond the right end, where it differs from space.boundary. Table [boundary.right].",
       [](c& o, const v& x) { o.faces.right = text_of(x); },
       [](const c& o) { return optional_text(o.faces.right); }},
      {"velocity.max", number, key_scope::velocity, true, none, 0, 1e6, true, nullptr,
       "The velocity grid covers [-max, max]; it must hold the tails of the data.",
       [](c& o, const v& x) { o.velocity.max = number_of(x); }, [](const c& o) { return v(o.velocity.max); }},
      {"velocity.points", integer, key_scope::velocity, true, none, 4, 100'000, false, nullptr,
       "Number of velocities (midpoints of equal intervals).",
       [](c& o, const v& x) { o.velocity.points = integer_of(x); },
       [](const c& o) { return v(long{o.velocity.points}); }},
      {"velocity.equilibrium", text, key_scope::velocity, false, "", 0, 0, false, equilibrium_choices,
       "Maxwellian by its formula, or with the discrete moments matched (conservative on any grid); auto "
       "measures which is needed.",
       [](c& o, const v& x) { o.velocity.equilibrium = text_of(x); },
       [](const c& o) { return v(o.velocity.equilibrium); }},
      {"time.method", text, key_scope::always, true, "", 0, 0, false, method_choices,
       "The time integrator, by its name in the catalogue, a member of a family (apsis list families) such "
       "as "
       "md-imex-chain-7-2, or a method file of yours (FILE.toml, relative to where the program runs).",
       [](c& o, const v& x) { o.time.method = text_of(x); }, [](const c& o) { return v(o.time.method); },
       method_besides},
      {"time.end", number, key_scope::always, true, none, 0, unlimited, false, nullptr,
       "Final time; the start is t = 0.", [](c& o, const v& x) { o.time.end = number_of(x); },
       [](const c& o) { return v(o.time.end); }},
      {"time.dt", number, key_scope::always, false, none, 0, unlimited, true, nullptr,
       "Step size. Exactly one of dt, cfl and safety is given.",
       [](c& o, const v& x) { o.time.dt = number_of(x); },
       [](const c& o) { return optional_number(o.time.dt); }},
      {"time.cfl", number, key_scope::space, false, none, 0, unlimited, true, nullptr,
       "Step size as dt = cfl * dx / v_max. Exactly one of dt, cfl and safety is given.",
       [](c& o, const v& x) { o.time.cfl = number_of(x); },
       [](const c& o) { return optional_number(o.time.cfl); }},
      {"time.safety", number, key_scope::space, false, none, 0, unlimited, true, nullptr,
       "Step size as dt = safety * r * dt_FE with the SSP coefficient r of the method and the forward Euler "
       "step dt_FE of the transport; positivity is guaranteed up to 1. Exactly one of dt, cfl and safety is "
       "given.",
       [](c& o, const v& x) { o.time.safety = number_of(x); },
       [](const c& o) { return optional_number(o.time.safety); }},
      {"time.startup", text, key_scope::always, false, "", 0, 0, false, startup_choices,
       "graded: the first step is cut into steps that double, from a quarter of the smallest epsilon/C on, "
       "so "
       "that the initial layer of data out of equilibrium is resolved; for methods whose layer is not 1 "
       "(apsis "
       "check). About log2(4 C dt/epsilon) more steps, none for epsilon = 0.",
       [](c& o, const v& x) { o.time.startup = text_of(x); }, [](const c& o) { return v(o.time.startup); }},
      {"time.tolerance", number, key_scope::always, false, none, 0, unlimited, true, nullptr,
       "Steps are chosen so that the estimated error of each, the 2-norm of the difference to the method's "
       "embedded solution relative to that of the state, stays below this; errors off equilibrium, which "
       "relax, "
       "count less in steps shorter than the tolerance asks for (docs/methods.md). dt, cfl or safety then "
       "says "
       "how long steps may be; startup = graded starts in the initial layer. For methods with an embedded "
       "solution (apsis list methods).",
       [](c& o, const v& x) { o.time.tolerance = number_of(x); },
       [](const c& o) { return optional_number(o.time.tolerance); }},
      {"output.every", number, key_scope::always, false, none, 0, unlimited, false, nullptr,
       "Time between snapshots of the fields; 0 keeps the final state only.",
       [](c& o, const v& x) { o.output.every = number_of(x); }, [](const c& o) { return v(o.output.every); }},
      {"output.fields", key_type::text_list, key_scope::always, false, "", 0, 0, false, nullptr,
       "Names of the macroscopic fields to write; empty writes all of the model.",
       [](c& o, const v& x) { o.output.fields = std::get<std::vector<std::string>>(x); },
       [](const c& o) { return v(o.output.fields); }},
      {"output.distribution", text, key_scope::always, false, "", 0, 0, false, distribution_choices,
       "Where the unknowns themselves (f) are written: nowhere, at the end into solution.h5, or also for "
       "every "
       "snapshot, into files of their own in snapshots/.",
       [](c& o, const v& x) { o.output.distribution = text_of(x); },
       [](const c& o) { return v(o.output.distribution); }},
      {"output.stride", integer, key_scope::always, false, "cells", 1, 10'000'000, false, nullptr,
       "Of every so many cells one is in the snapshots of f, beginning with the first.",
       [](c& o, const v& x) { o.output.stride = integer_of(x); },
       [](const c& o) { return v(long{o.output.stride}); }},
      {"output.precision", text, key_scope::always, false, "", 0, 0, false, precision_choices,
       "Of the numbers in the snapshots of f. In single precision they have 7 digits and are 0 below 1e-45. "
       "The end and checkpoints have every digit.",
       [](c& o, const v& x) { o.output.precision = text_of(x); },
       [](const c& o) { return v(o.output.precision); }},
      {"output.checkpoint_every", integer, key_scope::always, false, "steps", 0, 1'000'000'000, false,
       nullptr, "Steps between checkpoints; 0 writes none by steps. An interrupted run always leaves one.",
       [](c& o, const v& x) { o.output.checkpoint_every = integer_of(x); },
       [](const c& o) { return v(long{o.output.checkpoint_every}); }},
      {"output.checkpoint_minutes", number, key_scope::always, false, "minutes", 0, unlimited, false, nullptr,
       "Minutes of the clock between checkpoints; 0 writes none by time.",
       [](c& o, const v& x) { o.output.checkpoint_minutes = number_of(x); },
       [](const c& o) { return v(o.output.checkpoint_minutes); }},
      {"output.history_rows", integer, key_scope::always, false, "rows", 100, 10'000'000, false, nullptr,
       "Most rows of the history. A run of more steps keeps every 2nd, 4th, 8th, … step, the last one, and "
       "the "
       "steps at which a column is smallest or largest.",
       [](c& o, const v& x) { o.output.history_rows = integer_of(x); },
       [](const c& o) { return v(long{o.output.history_rows}); }},
  };
}

}  // namespace

const std::vector<case_key>& case_schema() {
  static const std::vector<case_key> schema = make_schema();
  return schema;
}

const std::vector<std::string>& step_keys() {
  static const std::vector<std::string> keys = {"time.dt", "time.cfl", "time.safety"};
  return keys;
}

bool is_step_key(const std::string& key) {
  return std::find(step_keys().begin(), step_keys().end(), key) != step_keys().end();
}

bool applies(const case_key& key, const model_entry& model) {
  switch (key.scope) {
    case key_scope::always:
      return true;
    case key_scope::space:
      return has_space(model);
    case key_scope::velocity:
      return model.has_velocity_grid;
  }
  return false;
}

std::string type_text(key_type type) {
  switch (type) {
    case key_type::integer:
      return "an integer";
    case key_type::number:
      return "a number";
    case key_type::text:
      return "a text";
    case key_type::formula:
      return "a number or a formula in x";
    case key_type::text_list:
      return "a list of texts";
    case key_type::number_pair:
      return "a pair of numbers";
  }
  return "";
}

std::string range_text(const case_key& key) {
  const bool numeric =
      key.type == key_type::integer || key.type == key_type::number || key.type == key_type::formula;
  if (!numeric) return "";
  const bool above = std::isfinite(key.lowest), below = std::isfinite(key.highest);
  if (above && below)
    return fmt::format("{} {} and at most {}", key.lowest_excluded ? "above" : "at least", key.lowest,
                       key.highest);
  if (above) return fmt::format("{} {}", key.lowest_excluded ? "above" : "at least", key.lowest);
  return below ? fmt::format("at most {}", key.highest) : "";
}

}  // namespace apsis
