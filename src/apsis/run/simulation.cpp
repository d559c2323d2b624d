#include <apsis/run/simulation.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/tolerance_forecast.hpp>
#include <apsis/run/memory_need.hpp>
#include <apsis/run/monitor.hpp>
#include <apsis/run/rounding.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {

std::string run_promises::text() const {
  std::vector<std::string> kept;
  if (positivity) kept.emplace_back("positivity");
  if (conservation) kept.emplace_back("conservation");
  if (entropy) kept.emplace_back("entropy decay");
  return kept.empty() ? "nothing is promised for this configuration; everything is reported"
                      : fmt::format("promised at every step: {}", fmt::join(kept, ", "));
}

namespace {

/// CPU time of the calling thread: what a step costs does not depend on what else the machine does.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// ‖u − v‖₂/‖u‖₂ over all cells and components.
double relative_distance(const field& u, const field& v) {
  double difference = 0.0, size = 0.0;
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < u.components(); ++k) {
      const double x = u.row(cell)[k], d = x - v.row(cell)[k];
      difference += d * d;
      size += x * x;
    }
  return difference == 0.0 ? 0.0 : std::sqrt(difference / size);
}
/// Why the error will be above the tolerance, and what helps.
std::string below_plateau(const method& used, double tolerance, const tolerance_forecast<double>& expected,
                          double relaxation) {
  const bool kept = used.claims.intermediate == "all";
  return fmt::format(
      "time.tolerance = {:g} is below what method '{}' keeps in steps of about {:.1g} (its terms of size "
      "epsilon "
      "leave a relative error of up to about {:.1g}); {}give time.dt below {:.1g} to resolve the relaxation, "
      "or a "
      "larger tolerance",
      tolerance, used.name, expected.dt, expected.error,
      kept ? "" : "choose a method with the right terms, as md-imex-8-3-mixed is, ",
      0.1 * std::min(relaxation, expected.dt));
}

/// The setup of a case whose state and buffers fit into memory.
run_setup setup_that_fits(const case_config& config) {
  run_setup setup(config);
  check_memory(config, setup, 0);
  return setup;
}

/// The times of a case. A given dt that does not divide output.every is a longest step, as with time.cfl.
time_marcher<double> times_of(const case_config& config, std::optional<double> dt) {
  const double every = config.output.every;
  time_marcher<double> march(0.0, config.time.end, dt);
  try {
    march.stop_every(every);
    if (march.adjusted())
      log::warning(
          fmt::format("time.dt = {:.17g} does not divide time.end = {:g}; dt = {:.17g} is used instead", *dt,
                      config.time.end, *march.fixed_dt()));
  } catch (const input_error&) {
    log::warning(
        fmt::format("time.dt = {:.17g} does not divide output.every = {:g} (steps are shortened to end at "
                    "every snapshot); "
                    "give one that does for steps of equal length",
                    *dt, every));
    march = time_marcher<double>(0.0, config.time.end);
    march.stop_every(every);
  }
  return march;
}
}  // namespace

struct simulation::impl {
  explicit impl(case_config configured)
      : config(std::move(configured)),
        setup(setup_that_fits(config)),
        problem(setup.make_problem()),
        integrator(setup.integrator(), *problem,
                   setup.has_tolerance() ? solutions::result_and_embedded : solutions::result),
        watch(*setup.equation, setup.cell_volume()),
        rounding(rounding_of(setup.integrator().coefficients<double>(), *setup.equation)),
        state(setup.initial_state()),
        march(times_of(config, setup.given_dt())) {
    if (setup.has_tolerance()) control.emplace(*config.time.tolerance, setup.integrator().embedded->order);
    first = last = watch.start(state);
    totals.min_value = first.min_value;
    totals.negative_values = first.negative_values;
    totals.phase_points = static_cast<long>(state.cells()) * state.components();
    if (march.done()) return;
    warn_of_explicit_collision();
    static_cast<void>(next_dt());  // throws where nothing limits the step
    // The first step may be shorter than those that follow.
    setup.decide_promises(promises, limit(), forward_euler_limit(), first.negative_values == 0,
                          has_exact_equilibrium());
    start_steps();
  }

  void start_steps() {
    const startup how = setup.has_graded_start() ? startup::graded : startup::none;
    if (control) {
      const double longest = std::min(limit(), config.time.end);
      warn_of_tolerance(longest);
      start_control(*problem, march.t(), state, longest, how, *control, relative_distance);
    } else if (how == startup::graded) {
      march.start_up(limit(), problem->relaxation_time(march.t(), state));
    }
  }

  void warn_of_tolerance(double longest) {
    const auto bounds = find_plateau_bounds(to_butcher(setup.integrator().coefficients<double>()));
    expected = forecast_tolerance(integrator, march.t(), state, config.time.end, longest, control->target(),
                                  bounds, relative_distance);
    if (expected->error > *config.time.tolerance)
      log::warning(below_plateau(setup.integrator(), *config.time.tolerance, *expected,
                                 problem->relaxation_time(march.t(), state)));
  }

  void warn_of_explicit_collision() {
    if (setup.integrator().kind != method_kind::explicit_only) return;
    const double relaxation = problem->relaxation_time(march.t(), state);
    const double steps = config.time.end / std::min(relaxation, next_dt());
    if (steps > 1e8)
      log::warning(fmt::format(
          "method '{}' is explicit and stable in steps of about epsilon/C = {:.1g} only, about {:.1g} of "
          "them to "
          "time.end = {:g} (the collision is stiff); choose an IMEX method, as md-imex-8-3-mixed is",
          setup.integrator().name, relaxation, steps, config.time.end));
  }

  /// Whether collisions conserve to rounding: E(ω) has the moments ω. A Maxwellian by formula may not.
  bool has_exact_equilibrium() const {
    const double defect = setup.equilibrium_defect(state);
    if (defect <= rounding.at_start) return true;  // what two sums over the components may differ by
    log::warning(fmt::format(
        "collisions do not conserve to rounding (the moments of the equilibrium miss those of the initial "
        "data by {:.2g}, so that conservation and entropy decay are not promised){}",
        defect, takes_formula() ? "; use velocity.equilibrium = \"auto\"" : ""));
    return false;
  }

  bool takes_formula() const {
    return config.velocity.points > 0 && config.velocity.equilibrium == "formula";
  }

  double forward_euler_limit() {
    return setup.ssp_coefficient() * problem->forward_euler_step(march.t(), state);
  }

  /// What the step rule of the case allows.
  double limit() {
    if (config.time.cfl) return *config.time.cfl * setup.cfl_length();
    if (config.time.safety) return *config.time.safety * forward_euler_limit();
    return march.fixed_dt().value_or(*config.time.dt);
  }

  double proposed() { return control ? std::min(limit(), control->proposed()) : limit(); }
  double next_dt() { return march.next(proposed()); }

  /// u ← u^{n+1}; returns Δt.
  double step() {
    if (control)
      return step_within_tolerance(integrator, march, *control, estimate, limit(), state, relative_distance);
    const double dt = next_dt();
    integrator.step(march.t(), dt, state);
    return dt;
  }

  void record_step(double dt) {
    march.advance(dt);
    const double previous = last.entropy;
    last = watch.check(state, previous);
    last.step = march.step();
    last.t = march.t();
    last.dt = dt;
    totals.steps = march.step();
    totals.t = march.t();
    totals.dt = std::max(totals.dt, dt);
    totals.min_value = std::min(totals.min_value, last.min_value);
    totals.negative_values += last.negative_values;
    for (const double defect : last.conservation_defect)
      totals.conservation_defect = std::max(totals.conservation_defect, defect);
    if (!std::isnan(last.entropy_change))
      totals.max_entropy_increase = std::max(totals.max_entropy_increase, last.entropy_change);
  }

  void keep_promises() const {
    const failure_site here{last.step, last.t, -1, std::numeric_limits<double>::quiet_NaN()};
    const auto broken = [&here](const std::string& what, double value) {
      failure_site site = here;
      site.value = value;
      throw numerical_error("broken promise: " + what, site);
    };
    if (promises.positivity && last.negative_values > 0)
      broken(
          fmt::format("{} values are negative (the configuration entails positivity)", last.negative_values),
          last.min_value);
    const double allowed = rounding.after(last.step);
    for (std::size_t k = 0; promises.conservation && k < last.conservation_defect.size(); ++k)
      if (!(last.conservation_defect[k] <= allowed))
        broken(fmt::format("{} is not conserved to rounding {}", setup.equation->invariants()[k],
                           reason_of_defect(allowed)),
               last.conservation_defect[k]);
    if (promises.entropy && last.entropy_change > 1e-13 * (1.0 + std::abs(last.entropy)))
      broken("the entropy increased (first-order upwind within r dt_FE entails decay)", last.entropy_change);
  }

  /// Why a conserved quantity changes by more than rounding explains, and what to do.
  std::string reason_of_defect(double allowed) const {
    if (takes_formula())
      return "(the velocity grid became too coarse for the Maxwellian by formula); use "
             "velocity.equilibrium = \"auto\"";
    if (setup.equation->positive() && last.negative_values > 0)
      return fmt::format(
          "(large values of both signs cancel: {} are negative, as happens beyond the step that "
          "strong stability allows); use space.limiter = \"positivity\" and time.safety = 1",
          last.negative_values);
    return fmt::format(
        "({} steps of {} explain {:.2g}: some equilibrium has other moments than the state); "
        "{}",
        last.step, setup.integrator().name, allowed,
        config.velocity.points > 0 ? "use velocity.equilibrium = \"discrete\", or more velocity.points"
                                   : "check the moments of the equilibrium of the model");
  }

  case_config config;
  run_setup setup;
  std::unique_ptr<semidiscrete_problem> problem;
  stepper<semidiscrete_problem> integrator;
  monitor watch;
  rounding_bound rounding;
  field state;
  time_marcher<double> march;
  std::optional<step_controller<double>> control;
  error_estimate<semidiscrete_problem> estimate;
  std::optional<tolerance_forecast<double>> expected;
  run_promises promises;
  step_record first, last;
  run_summary totals;
};

namespace {
std::vector<double> without_padding(const field& u) {
  std::vector<double> values;
  for (int cell = 0; cell < u.cells(); ++cell)
    values.insert(values.end(), u.row(cell), u.row(cell) + u.components());
  return values;
}
}  // namespace

simulation::simulation(case_config config) : impl_(std::make_unique<impl>(std::move(config))) {}
simulation::~simulation() = default;
simulation::simulation(simulation&&) noexcept = default;
simulation& simulation::operator=(simulation&&) noexcept = default;

const case_config& simulation::config() const {
  return impl_->config;
}
const run_promises& simulation::promises() const {
  return impl_->promises;
}
std::vector<std::string> simulation::invariants() const {
  return impl_->setup.equation->invariants();
}
double simulation::t() const {
  return impl_->march.t();
}
double simulation::dt() const {
  return impl_->march.done() ? 0.0 : impl_->next_dt();
}
long simulation::step() const {
  return impl_->march.step();
}
long simulation::steps_total() const {
  if (finished()) return step();
  // The first step to a tolerance resolves the layer; those that follow are as long as was forecast.
  if (step() == 0 && impl_->expected) return impl_->march.steps_left(impl_->expected->dt);
  return step() + impl_->march.steps_left(impl_->march.starting() ? impl_->limit() : impl_->proposed());
}
long simulation::snapshot_times_passed() const {
  const double every = config().output.every;
  return every > 0.0 ? multiples_until(t(), every) : 0;
}
bool simulation::next_step_depends_on_end() const {
  // Far from the end the question is not worth a forward Euler step: no rule makes steps 32 times longer.
  const bool far = step() > 0 && !impl_->march.starting() && config().time.end - t() > 64.0 * last().dt;
  if (far || finished()) return false;
  return impl_->march.shaped_by_end(impl_->proposed());
}
double simulation::expected_plateau() const {
  return impl_->expected ? impl_->expected->error : 0.0;
}
bool simulation::finished() const {
  return impl_->march.done();
}

const step_record& simulation::advance() {
  const auto start = std::chrono::steady_clock::now();
  const double cpu = thread_seconds();
  impl& run = *impl_;
  try {
    run.record_step(run.step());
  } catch (const numerical_error& failure) {
    throw failure.site().step >= 0 ? failure : failure.at(run.march.step() + 1, run.march.t());
  }
  run.totals.wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  run.totals.cpu_s += thread_seconds() - cpu;
  run.keep_promises();
  return run.last;
}

const step_record& simulation::last() const {
  return impl_->last;
}
const step_record& simulation::initial_record() const {
  return impl_->first;
}

run_summary simulation::summary() const {
  run_summary summary = impl_->totals;
  const auto& control = impl_->control;
  summary.rejected_steps = control ? control->rejected() : 0;
  const double work = static_cast<double>(summary.phase_points) *
                      static_cast<double>(summary.steps + summary.rejected_steps) *
                      static_cast<double>(impl_->setup.integrator().stages() + (control ? 1 : 0));
  summary.t = t();
  summary.startup_steps = impl_->march.startup_steps();
  summary.point_stages_per_s = summary.wall_s > 0.0 ? work / summary.wall_s : 0.0;
  return summary;
}

field_table simulation::fields() const {
  const model& equation = *impl_->setup.equation;
  field_table table;
  for (const auto& name : equation.fields()) {
    table.names.push_back(name.name);
    table.labels.push_back(name.label);
  }
  table.x = impl_->setup.centres();
  table.values.assign(table.names.size(), {});
  std::vector<double> values(table.names.size());
  for (int cell = 0; cell < cells(); ++cell) {
    equation.macroscopic(impl_->state.row(cell), values.data());
    for (std::size_t k = 0; k < values.size(); ++k) table.values[k].push_back(values[k]);
  }
  return table;
}

bool simulation::has_space() const {
  return impl_->setup.has_space();
}
int simulation::cells() const {
  return impl_->state.cells();
}
int simulation::components() const {
  return impl_->state.components();
}

std::vector<double> simulation::state() const {
  return without_padding(impl_->state);
}

std::vector<double> simulation::exact_state() const {
  const auto exact = impl_->setup.exact_state(t());
  return exact ? without_padding(*exact) : std::vector<double>{};
}

std::vector<double> simulation::velocities() const {
  const auto speeds = impl_->setup.equation->speeds(0);
  return {speeds.begin(), speeds.end()};
}
std::vector<double> simulation::epsilon() const {
  return impl_->setup.epsilon_at_centres();
}

saved_run simulation::save() const {
  const auto march = impl_->march.save();
  saved_run saved;
  saved.state = state();
  saved.step = march.step;
  saved.since_anchor = march.since_anchor;
  saved.t = march.t;
  saved.anchor = march.anchor;
  saved.anchor_dt = march.anchor_dt;
  saved.startup_steps = march.startup_steps;
  saved.startup_done = march.startup_done;
  saved.startup_length = march.startup_length;
  if (impl_->control) {
    const auto control = impl_->control->save();
    saved.proposed_dt = control.proposed;
    saved.previous_error = control.previous;
    saved.step_holds = control.holds;
  }
  saved.so_far = summary();
  saved.initial = impl_->first;
  saved.last = impl_->last;
  return saved;
}

void simulation::restore(const saved_run& saved) {
  if (saved.state.size() != static_cast<std::size_t>(cells()) * static_cast<std::size_t>(components()))
    throw input_error(
        "the saved state has another size than the case (it belongs to another case); restart with the case "
        "it was written for");
  for (int cell = 0; cell < cells(); ++cell)
    std::copy_n(saved.state.data() + static_cast<std::ptrdiff_t>(cell) * components(), components(),
                impl_->state.row(cell));
  // Before the first step there is nothing but what the case says.
  if (saved.step > 0)
    impl_->march.resume({saved.step, saved.since_anchor, saved.t, saved.anchor, saved.anchor_dt,
                         saved.startup_steps, saved.startup_done, saved.startup_length});
  if (impl_->control)
    impl_->control->resume(
        {saved.proposed_dt, saved.previous_error, saved.step_holds, saved.so_far.rejected_steps});
  impl_->totals = saved.so_far;
  impl_->first = saved.initial;
  impl_->last = saved.last;
}

}  // namespace apsis
