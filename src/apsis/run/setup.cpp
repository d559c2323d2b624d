#include <apsis/run/setup.hpp>

#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/boundary_support.hpp>
#include <apsis/config/force_reader.hpp>
#include <apsis/config/method_of_case.hpp>
#include <apsis/config/prescribed_data.hpp>
#include <apsis/config/solid_reader.hpp>
#include <apsis/config/source_reader.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/device/on_device.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/exec/global_sum.hpp>
#include <apsis/exec/interruption.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/mesh/on_host.hpp>
#include <apsis/method/step_law.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/run/body_warnings.hpp>
#include <apsis/run/cfl_limit.hpp>
#include <apsis/run/initial_file.hpp>
#include <apsis/run/velocity_watch.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Throws input_error, at the place of a key if this is known.
[[noreturn]] void refuse(const case_config& config, const std::string& key, const std::string& message) {
  const bool prescribed = key == "model.initial" && !config.prescribed.empty();
  const source_place place = place_of(config, prescribed ? "initial" : key);
  if (place.file.empty()) throw input_error(message);
  throw input_error(place, message);
}

/// Returns the smallest and the largest value of every macroscopic field.
std::pair<std::vector<double>, std::vector<double>> extremes_of_fields(const model& equation,
                                                                       const grid& mesh, const field& u) {
  const field_group fields = equation.fields().front();
  std::vector<double> values(fields.names.size());
  std::vector<double> lowest(values.size(), std::numeric_limits<double>::infinity()), highest(values.size());
  for (double& value : highest) value = -std::numeric_limits<double>::infinity();
  for (int cell = 0; cell < u.cells(); ++cell) {
    interruptible::poll();
    if (mesh.solid(cell) >= 0) continue;
    fields.compute({u.row(cell)}, values.data());
    for (std::size_t k = 0; k < values.size(); ++k) {
      lowest[k] = std::min(lowest[k], values[k]);
      highest[k] = std::max(highest[k], values[k]);
    }
  }
  return {lowest, highest};
}

/// Returns space.blocks as one number for each of three directions; nothing if it is not given.
std::optional<std::array<int, 3>> given_blocks(const std::optional<std::vector<int>>& blocks) {
  if (!blocks) return std::nullopt;
  std::array<int, 3> all = {1, 1, 1};
  std::copy(blocks->begin(), blocks->end(), all.begin());
  return all;
}

/// Calls body() and adds the place of a key to its input errors.
template <class Body>
void at_key(const case_config& config, const std::string& key, const Body& body) {
  try {
    body();
  } catch (const input_error& failure) {
    refuse(config, key, fmt::format("{}: {}", key, failure.what()));
  }
}

}  // namespace

run_setup::run_setup(const case_config& config, std::shared_ptr<communicator> processes,
                     std::shared_ptr<device> on)
    : equation(make_model(config)),
      config_(with_chosen_method(config)),
      device_(std::move(on)),
      builder_(*equation) {
  integrator_ = &find_integrator(config_.time.method);
  set_stability_limit();
  check_method();
  if (has_space())
    build_space(std::move(processes));
  else
    builder_.shared_by(std::move(processes));
  set_epsilon();
  set_prescribed_data();
  if (ssp_coefficient() == 0.0 || integrator_->needs.explicit_collision) builder_.with_smooth_collisions();
  if (integrator_->starter().kind == method_kind::explicit_only) builder_.with_explicit_collision();
  if (integrator_->needs.exact_collision) builder_.with_exact_collision();
  if (device_) move_to_device();
}

void run_setup::move_to_device() {
  const auto missing = [&](const std::string& key, const std::string& what) {
    refuse(config_, key,
           what + " is not possible on a device (its kernels are missing); run the case on the host");
  };
  if (!has_space()) missing("model.name", "a model without space");
  if (config_.space.discretization != "finite-difference")
    missing("space.formulation", "space.formulation = \"" + config_.space.discretization + "\"");
  if (config_.steady_state.tolerance) missing("steady", "a table [steady]");
  builder_.with_discretization(on_device(*device_, config_.space.reconstruction));
}

const memory_space& run_setup::memory() const {
  return device_ ? device_->memory() : host_memory();
}

void run_setup::build_space(std::shared_ptr<communicator> processes) {
  const auto& space = config_.space;
  const reconstruction_entry& scheme = find_reconstruction(space.reconstruction);
  const grid mesh = make_mesh(config_);
  builder_.on(mesh).with_discretization(space.discretization);
  if (mesh.has_axis()) builder_.with_axis(mesh.dimensions() - 1);
  if (space.collisions) builder_.with_collisions_at(*space.collisions);
  at_key(config_, space.blocks ? "space.blocks" : "space.cells",
         [&] { builder_.shared_by(std::move(processes), given_blocks(space.blocks)); });
  const auto sides = make_boundaries(config_, equation);
  for (int direction = 0; direction < static_cast<int>(sides.size()); ++direction)
    for (const bool upper : {false, true})
      builder_.with_boundary({direction, upper}, sides[static_cast<std::size_t>(direction)][upper ? 1 : 0]);
  const auto walls = make_solid_walls(config_, equation);
  for (std::size_t k = 0; k < walls.size(); ++k) builder_.with_solid(static_cast<int>(k), walls[k]);
  if (auto of = make_acceleration(config_, *equation)) builder_.with_force(std::move(*of));
  if (auto rate = make_source(config_, *equation)) builder_.with_source(std::move(*rate));
  at_key(config_, "space.limiter", [&] {
    if (space.limiter == limiter_choice::positivity) builder_.with_positivity_limiter();
  });
  at_key(config_, "space.cells", [&] { builder_.with_reconstruction(scheme.make()); });
}

void run_setup::set_epsilon() {
  const auto formula =
      std::make_shared<const expression>(make_epsilon(config_, equation->space_dimensions()));
  builder_.with_epsilon([formula](const position& x) { return formula->evaluate(x); });
}

void run_setup::check_method() {
  const bool transports = has_space() || equation->has_source();
  const method& first = integrator_->starter();
  if (first.kind == method_kind::implicit_only && transports)
    refuse(config_, "time.method",
           fmt::format("method '{}' cannot integrate model '{}' (it is implicit only and the model has "
                       "transport); choose an IMEX or explicit method",
                       first.name, config_.model.name));
  if (integrator_->needs.exact_collision && !equation->has_exact_collision())
    refuse(config_, "time.method",
           fmt::format("method '{}' cannot integrate model '{}' (it is {}, and collisions of the model "
                       "have no solution in closed form); choose an IMEX method",
                       first.name, config_.model.name, to_string(first.kind)));
  check_startup();
  check_tolerance();
}

void run_setup::set_stability_limit() {
  const reconstruction_entry* scheme = try_find_reconstruction(config_.space.reconstruction);
  if (!has_space() || scheme == nullptr) return;  // an unknown one is refused later
  const auto reconstruct = scheme->make();
  stability_limit_ = cfl_limit(integrator_->growth(), *reconstruct);
}

double run_setup::step_coefficient() const {
  if (!has_space()) return ssp_coefficient();
  const double stable = stability_limit_ / builder_.cfl_number();
  return ssp_coefficient() == 0.0 ? stable : std::min(ssp_coefficient(), stable);
}

void run_setup::check_startup() const {
  if (!has_graded_start()) {
    if (config_.time.startup_growth != default_growth)
      refuse(config_, "time.startup_growth",
             "time.startup_growth has no meaning without a graded start (it is the ratio of its times); give "
             "time.startup = \"graded\" too, "
             "or remove it");
    return;
  }
  const method& first = integrator_->starter();
  if (first.kind == method_kind::explicit_only)
    refuse(
        config_, "time.startup",
        fmt::format("time.startup = \"graded\" has no meaning for method '{}' (it is explicit: steps that do "
                    "not resolve the layer are unstable later too); remove it or choose an IMEX method",
                    first.name));
  if (!equation->has_relaxation_time())
    refuse(config_, "time.startup",
           fmt::format("time.startup = \"graded\" has no meaning for model '{}' (its relaxation time is not "
                       "known); remove it",
                       config_.model.name));
}

void run_setup::check_tolerance() const {
  if (!has_tolerance()) {
    if (config_.time.controller != usual_step_law)
      refuse(config_, "time.controller",
             "time.controller has no meaning without a tolerance (it follows the estimated errors); give "
             "time.tolerance too, or remove it");
    return;
  }
  if (integrator_->needs.equal_steps)
    refuse(
        config_, "time.tolerance",
        fmt::format("time.tolerance cannot be kept: method '{}' needs equal steps (its coefficients depend "
                    "on earlier steps); give time.dt or time.cfl, or choose a method of one step",
                    integrator_name()));
  if (integrator_->one_step() == nullptr)
    refuse(config_, "time.tolerance",
           fmt::format(
               "time.tolerance cannot be kept: method '{}' does not estimate the errors of its steps; give "
               "time.dt or time.cfl, or choose a Runge-Kutta method",
               integrator_name()));
  // The estimate is the relative difference of two double-precision numbers, so rounding limits it.
  constexpr double finest = 64.0 * std::numeric_limits<double>::epsilon();
  if (*config_.time.tolerance < finest)
    refuse(config_, "time.tolerance",
           fmt::format(
               "time.tolerance = {:g} cannot be kept (the rounding of an estimate is of this size); give "
               "at least {:.2g}",
               *config_.time.tolerance, finest));
}

std::vector<std::string> run_setup::open_faces() const {
  std::vector<std::string> open;
  if (!has_space()) return open;
  const domain& space = builder_.space();
  for (const budget_surface& one : space.budget_surfaces())
    open.push_back(one.solid < 0 ? face_names[one.where.index()] : solid_name(one.solid));
  if (config_.force.acceleration) open.emplace_back(force_balance);
  if (builder_.axis()) open.emplace_back(rotation_balance);
  if (!config_.source_term.empty()) open.emplace_back(source_balance);
  return open;
}

std::string run_setup::solid_name(int solid) const {
  const auto number = static_cast<std::size_t>(solid), boxes = config_.solids.size();
  return number < boxes ? config_.solids[number].name : config_.bodies[number - boxes].name;
}

std::vector<std::size_t> run_setup::open_ends() const {
  std::vector<std::size_t> ends;
  if (!has_space()) return ends;
  const domain& space = builder_.space();
  for (const budget_surface& one : space.budget_surfaces()) ends.push_back(space.ends_at(one));
  ends.resize(open_faces().size(), 1);
  return ends;
}

std::optional<std::vector<double>> run_setup::entropy_bounds() const {
  std::vector<double> all;
  if (!has_space()) return all;
  if (config_.force.acceleration || builder_.axis() || !config_.source_term.empty()) return std::nullopt;
  const auto of_faces = builder_.space().entropy_bounds();
  if (!of_faces) return std::nullopt;
  const std::size_t count = equation->invariants().size();
  for (std::vector<double> one : *of_faces) {
    one.resize(count);
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

std::size_t run_setup::stages_of_step() const {
  if (!has_tolerance()) return stages();
  return integrator_->starter().embedded ? stages() + 1 : 3 * stages();
}

std::unique_ptr<semidiscrete_problem> run_setup::make_problem() const {
  return builder_.build();
}

std::unique_ptr<semidiscrete_problem> run_setup::make_implicit_problem() const {
  return problem_builder(builder_).with_implicit_collision().build();
}

void run_setup::set_prescribed_data() {
  if (config_.prescribed.empty() || config_.prescribed.given_elsewhere()) return;
  const auto given = std::make_shared<const prescribed_data>(
      config_, *equation, [this](const std::string& path) { return place_of(config_, path); });
  const std::vector<double> jumps = has_space() ? given->jumps(whole_mesh()) : std::vector<double>{};
  prescribed_ = {"initial",
                 "table [initial]",
                 [given](const position& x, std::span<double> u) { (*given)(x, u); },
                 {},
                 jumps};
}

const initial_data& run_setup::data() const {
  if (!config_.prescribed.empty()) return prescribed_;  // has no functions if the data are given elsewhere
  const auto& all = equation->initial();
  const auto found = std::find_if(all.begin(), all.end(), [this](const auto& item) {
    return config_.model.initial.empty() || item.name == config_.model.initial;
  });
  if (found == all.end()) throw input_error("unknown initial data '" + config_.model.initial + "'");
  return *found;
}

field run_setup::initial_state() const {
  if (config_.prescribed.from_python)
    refuse(config_, "initial.from",
           "the case has no initial data (they were given in Python); run it with apsis.run(case, "
           "initial=...), or continue from a checkpoint");
  state_of_file read;
  run_collectively(processes(), [&] {
    if (config_.prescribed.file.empty())
      read.state = builder_.sample(data().point_value, data().jumps);
    else
      read = sample_initial_file(config_, *equation, builder_);
  });
  return checked(std::move(read.state), read.from_result);
}

const field& run_setup::densities(const field& u, field& room) const {
  if (!mesh().has_axis()) return on_host(u, room);
  room = u;
  for (int cell = 0; cell < u.cells(); ++cell) {
    if (mesh().solid(cell) >= 0) continue;
    const double r = mesh().radius(mesh().centre(cell));
    for (double& value : std::span(room.row(cell), static_cast<std::size_t>(u.components()))) value /= r;
  }
  return room;
}

field run_setup::checked(field u, bool computed) const {
  // They come first, because a number without its unit may be the cause of an error below.
  for (const std::string& warning : config_.unit_warnings) log::warning(warning);
  std::vector<std::string> warnings;
  run_collectively(processes(), [&] { warnings = check_emitted_gas(config_, *equation); });
  for (const std::string& warning : warnings) log::warning(warning);
  if (has_space())
    for (const std::string& warning : warnings_of_bodies(config_, whole_mesh())) log::warning(warning);
  check_cells(u, computed);
  std::vector<double> lowest, highest;
  run_collectively(processes(), [&] {
    field room;
    std::tie(lowest, highest) = extremes_of_fields(*equation, mesh(), densities(u, room));
  });
  for (double& value : highest) value = -value;
  processes().lowest(lowest);
  processes().lowest(highest);
  for (double& value : highest) value = -value;
  const unsupported_initial_data found = equation->check_supported_range(lowest.data(), highest.data());
  if (!found.problem.empty()) refuse(config_, found.key, found.problem);
  return u;
}

void run_setup::check_cells(const field& u, bool computed) const {
  const auto support = support_of(*equation);
  std::vector<double> omega(support ? static_cast<std::size_t>(support->molecules().moment_count()) : 0),
      worst(omega.size());
  double missed = 0.0;
  int worst_cell = -1;
  run_collectively(processes(), [&] {
    for (int cell = 0; cell < u.cells(); ++cell) {
      interruptible::poll();
      if (mesh().solid(cell) >= 0) continue;
      fluid_state state;
      std::optional<velocity_fit> fit;
      if (support) {
        support->molecules().moments(u.row(cell), 0, 1, omega.data());
        if (support->is_safe(support->margins(omega.data()))) continue;
        fit = support->fit_of_moments(omega.data(), state);
      }
      if (!fit || fit->missed > velocity_limits::bad) {
        const unsupported_initial_data found =
            fit ? velocity_problem(support->molecules(), state, *fit, words_of(config_, "the data"))
                : equation->check_supported(u.row(cell));
        if (!found.problem.empty() && !(computed && fit))
          refuse(config_, found.key, fmt::format("{} [cell {}]", found.problem, number_in_whole_mesh(cell)));
      }
      if (!fit || !(fit->missed > missed)) continue;
      missed = fit->missed;
      worst = omega;
      worst_cell = cell;
    }
  });
  if (support) warn_of_velocities(*support, missed, worst_cell, worst);
}

/// Warns about the cell whose Maxwellian the velocities miss most, over all processes, if they miss too much.
void run_setup::warn_of_velocities(const velocity_support& support, double missed, int cell,
                                   const std::vector<double>& omega) const {
  const bool mine = cell >= 0 && missed > velocity_limits::good;
  const auto found = worst_of_all(processes(), missed, mine ? number_in_whole_mesh(cell) : -1, omega);
  if (!found) return;
  fluid_state state;
  const auto fit = support.fit_of_moments(found->omega.data(), state);
  const auto problem =
      velocity_problem(support.molecules(), state, *fit, words_of(config_, "the data")).problem;
  log::warning(fmt::format("{} [cell {}]", problem, found->cell));
}

std::optional<field> run_setup::exact_state(double t) const {
  const auto& exact = data().exact;
  if (!exact) return std::nullopt;
  return builder_.sample([&](const position& x, std::span<double> u) { exact(t, x, u); });
}

double run_setup::cfl_length() const {
  if (!has_space()) throw input_error("time.cfl needs a mesh (the model has no space); give time.dt");
  return 1.0 / builder_.cfl_rate();
}

double run_setup::equilibrium_defect(const field& state) const {
  field room;
  const field& u = on_host(state, room);
  const auto* relaxation = equation->as_relaxation();
  if (relaxation == nullptr || equation->invariants().empty()) return 0.0;
  const std::size_t count = equation->invariants().size();
  std::vector<double> omega(static_cast<std::size_t>(relaxation->moment_count()));
  std::vector<double> e(static_cast<std::size_t>(u.components()));
  std::vector<double> before(count), after(count), scales(count);
  std::vector<exact_sum> missed(count), all(count);
  const auto add_cell = [&](int cell) {
    if (mesh().solid(cell) >= 0) return;
    relaxation->moments(u.row(cell), omega.data());
    if (!relaxation->equilibrium(omega.data(), e.data())) return;  // reported by the first step
    equation->invariant_densities(u.row(cell), before.data());
    equation->invariant_densities(e.data(), after.data());
    equation->invariant_scales(before, scales.data());
    for (std::size_t k = 0; k < count; ++k) {
      missed[k].add(std::abs(after[k] - before[k]));
      all[k].add(scales[k]);
    }
  };
  run_collectively(processes(), [&] {
    for (int cell = 0; cell < u.cells(); ++cell) {
      interruptible::poll();
      add_cell(cell);
    }
  });
  const std::vector<double> defects = global_values(processes(), missed),
                            sizes = global_values(processes(), all);
  double worst = 0.0;
  for (std::size_t k = 0; k < count; ++k)
    if (sizes[k] > 0.0) worst = std::max(worst, defects[k] / sizes[k]);
  return worst;
}

void run_setup::decide_promises(run_promises& promises, double dt, double limit, bool nonnegative,
                                bool exact_equilibrium) const {
  const bool within = ssp_coefficient() > 0.0 && dt <= limit;
  // An explicit Q/epsilon beyond its step limit amplifies its rounding in the invariants by dt/epsilon.
  const bool explicit_collision = integrator_->needs.explicit_collision;
  promises.conservation =
      exact_equilibrium && !equation->invariants().empty() && (within || !explicit_collision);
  // Stage solves keep the sign of every row. An explicit Q does so only if the target is an equilibrium, E ≥
  // 0, and averages are means of values at points.
  const auto* relaxation = equation->as_relaxation();
  const bool relaxes = relaxation != nullptr && relaxation->relaxing_count() > 0;
  const bool collisions = equation->collisions_keep_sign() &&
                          !(explicit_collision && (relaxes || builder_.collisions().reach > 0));
  promises.condition = equation->condition();
  promises.why_signed = equation->why_signed();
  promises.positivity = equation->positive() && collisions && nonnegative && within && builder_.keeps_sign();
  // An equilibrium with other moments does not minimize the entropy among the states with the
  // moments of the data.
  promises.entropy = collisions_decrease_entropy(*equation) && nonnegative && within &&
                     builder_.first_order() && exact_equilibrium && entropy_bounds().has_value();
}

}  // namespace apsis
