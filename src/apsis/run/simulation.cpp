#include <apsis/run/simulation.hpp>

#include <apsis/config/method_of_case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/exec/thread_clock.hpp>
#include <apsis/integrate/any_stepper.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/tolerance_forecast.hpp>
#include <apsis/run/compute_fields.hpp>
#include <apsis/run/compute_surfaces.hpp>
#include <apsis/run/gathered_cells.hpp>
#include <apsis/run/loss_watch.hpp>
#include <apsis/run/memory_need.hpp>
#include <apsis/run/monitor.hpp>
#include <apsis/run/promises.hpp>
#include <apsis/run/ray_warning.hpp>
#include <apsis/run/rounding.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/stability_watch.hpp>
#include <apsis/run/state_distance.hpp>
#include <apsis/run/step_plan.hpp>
#include <apsis/run/whole_budget.hpp>
#include <apsis/steady/steady_solver.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace apsis {

namespace {

/// Returns the setup of a case if its state and buffers fit into memory.
std::unique_ptr<run_setup> setup_that_fits(const case_config& config,
                                           const std::shared_ptr<communicator>& processes) {
  std::unique_ptr<run_setup> setup;
  run_collectively(*processes, [&] {
    setup = std::make_unique<run_setup>(config, processes);
    check_memory(*setup, 0);
  });
  return setup;
}

std::unique_ptr<semidiscrete_problem> problem_of(const run_setup& setup) {
  std::unique_ptr<semidiscrete_problem> problem;
  run_collectively(setup.processes(), [&] { problem = setup.make_problem(); });
  return problem;
}

}  // namespace

struct simulation::impl {
  impl(std::unique_ptr<run_setup> prepared, const state_source& start)
      : made(std::move(prepared)),
        setup(*made),
        config(setup.config()),
        problem(problem_of(setup)),
        budgeted(*problem),
        integrator(make_stepper(setup.integrator(), budgeted,
                                setup.has_tolerance() ? solutions::result_and_embedded : solutions::result)),
        watch(setup),
        stability(setup),
        rounding(rounding_of(setup)),
        now{start ? start(setup) : setup.initial_state(), {}},
        march(times_of(setup)),
        losses(setup, *problem) {
    if (setup.has_tolerance()) {
      const auto& of_one_step = *integrator->one_step();  // others were refused by the setup
      control.emplace(*config.time.tolerance, estimate_of(setup.integrator().starter()).order);
      estimate.emplace(of_one_step.weight_of_estimate(), of_one_step.resolves_collisions());
    }
    if (!finds_steady_state()) limit_for_steps();
    first = last = watch.start(state);
    totals.min_value = first.min_value;
    totals.negative_values = first.negative_values;
    watch.watch_velocities(state, first, totals);
    totals.phase_points = static_cast<long>(setup.whole_mesh().size()) * state.components();
    if (finds_steady_state()) start_iterations();
    if (finds_steady_state() || march.done()) return;
    warn_of_dense_stages(setup);
    const double relaxation = problem->relaxation_time(march.t(), state);
    warn_of_stiff_collision(setup, relaxation, next_dt());
    warn_of_fast_source(problem->growth_of_source(march.t(), state), next_dt());
    warn_of_unstable_steps(setup, next_dt());
    warn_of_rays(setup, relaxation);
    // The first step may be shorter than those that follow.
    setup.decide_promises(promises, limit(), forward_euler_limit(), first.negative_values == 0,
                          conserves_to_rounding(setup, state, rounding));
    start_steps(relaxation);
    start_watch();
    problem->take_cut();  // of steps that were only tried
  }

  bool finds_steady_state() const { return config.steady_state.tolerance.has_value(); }

  void start_iterations() {
    first.residual = last.residual = {std::numeric_limits<double>::quiet_NaN()};
    const auto& [tolerance, iterations, images] = config.steady_state;
    run_collectively(setup.processes(), [&] {
      iteration.emplace(*setup.equation->as_relaxation(), setup.builder(), *problem, state,
                        steady_options{*tolerance, iterations, images});
    });
    warn_of_rays(setup, problem->relaxation_time(0.0, state));
    problem->take_cut();
  }

  /// An iteration to the steady state in place of a step. Fluxes are those of the last residual; what the gas
  /// received since the start is nothing, and defects of conservation are the net rates.
  void iterate() {
    const steady_iteration done = iteration->iterate(state);
    march.advance(1.0);
    const std::span<const double> rates = problem->budget_rates();
    now.budget = boundary_budget({rates.begin(), rates.end()});
    budget = now.budget.amounts();
    last = watch.check(now, 1.0, last, problem->take_cut());
    found = done.converged;
    last.step = march.step();
    last.t = march.t();
    last.dt = 1.0;
    last.change = done.change;
    last.residual = {done.residual};
    last.received = first.received;
    last.entropy_change = std::numeric_limits<double>::quiet_NaN();
    set_net_rates();
    totals.steps = march.step();
    totals.dt = 1.0;
    totals.min_value = last.min_value;
    totals.negative_values = last.negative_values;
    totals.conservation_defect = 0.0;
    for (const double rate : last.conservation_defect)
      totals.conservation_defect = std::max(totals.conservation_defect, rate);
    for (const double cut : last.cut) totals.largest_cut = cut;
    if (!found && march.done())
      throw numerical_error(fmt::format("no steady state in {} iterations (residual {:.2g}, change of the "
                                        "moments {:.2g}); give a larger steady.iterations, or march in time",
                                        config.steady_state.iterations, done.residual, done.change),
                            {last.step, last.t});
  }

  void set_net_rates() {
    const std::size_t count = last.total.size();
    std::vector<double> scales(count);
    setup.equation->invariant_scales(last.total, scales.data());
    for (std::size_t k = 0; k < count; ++k) {
      double net = 0.0;
      for (std::size_t n = k; n < last.flux.size(); n += count) net += last.flux[n];
      last.conservation_defect[k] = scales[k] > 0.0 ? std::abs(net) / scales[k] : std::abs(net);
    }
    last.defect_of_step = last.conservation_defect;
  }

  /// ‖u − v‖₂/‖u‖₂, after the errors that processes met while they computed u and v.
  auto distance() {
    return [this](const auto& u, const auto& v) {
      problem->throw_late_errors();
      return relative_distance(unknowns_of(u), unknowns_of(v), setup.processes());
    };
  }
  static const field& unknowns_of(const field& u) { return u; }
  static const field& unknowns_of(const budgeted_state& u) { return u.unknowns; }

  void start_steps(double relaxation) {
    if (control) {
      const double longest = std::min(limit(), config.time.end);
      warn_of_tolerance(longest, relaxation);
      const auto rule = step_rule<double>::unlimited().with(
          setup.has_graded_start() ? startup::graded : startup::none, config.time.startup_growth);
      start_control(*problem, march.t(), state, longest, rule, *control, distance());
      warn_of_layer(setup, *problem, state, relaxation, control->proposed());
    } else if (setup.has_graded_start()) {
      march.start_up(limit(), relaxation);
    }
  }

  void warn_of_tolerance(double longest, double relaxation) {
    if (setup.integrator().starter().kind == method_kind::explicit_only) return;  // resolves the relaxation
    const auto bounds = compute_plateau_bounds(to_butcher(setup.integrator().form));
    expected = forecast_tolerance(*integrator->one_step(), march.t(), now, config.time.end, longest,
                                  control->target(), bounds, distance());
    warn_of_plateau(setup, *expected, relaxation);
  }

  /// Estimates what the method loses in the usual steps. A forecast above the tolerance has been reported.
  void start_watch() {
    const double dt = expected ? expected->dt : limit();
    if (expected && expected->error > *config.time.tolerance) return;
    const bool layer = !control && !setup.has_graded_start();
    losses.start(march.t(), state, std::min(dt, config.time.end - march.t()), layer);
  }

  /// Steps that are known to be shorter than the longest need less of the limiter.
  void limit_for_steps() {
    if (control) return;
    limiter_share = problem->share_of_longest_step(setup.ssp_coefficient(), limit(), march.t(), state);
    problem->limit_for_steps(limiter_share);
  }

  double forward_euler_limit() {
    return setup.ssp_coefficient() * problem->forward_euler_step(march.t(), state);
  }

  /// Returns the step limit of the case.
  double limit() {
    if (config.time.cfl) return *config.time.cfl * setup.cfl_length();
    if (config.time.safety)
      return *config.time.safety * (setup.step_coefficient() * problem->forward_euler_step(march.t(), state));
    return march.fixed_dt().value_or(*config.time.dt);
  }

  double proposed() { return control ? std::min(limit(), control->proposed()) : limit(); }
  double next_dt() { return march.next(proposed()); }

  /// Whether the change of the last step is at most time.steady.
  bool steady() const { return config.time.steady && last.change <= *config.time.steady; }

  /// u ← u^{n+1}; returns Δt.
  double step() {
    begin_budget();
    if (config.time.steady) before = state;
    if (control)
      return step_within_tolerance(*integrator->one_step(), march, *control, *estimate, limit(), now,
                                   distance());
    const double dt = next_dt();
    integrator->step(march, dt, now);
    return dt;
  }

  /// A budget counts from the beginning of a step. Those of kept values, which are sums of earlier u, are
  /// shifted by what u received in the last step.
  void begin_budget() {
    integrator->visit_kept(
        [this](budgeted_state& kept, double weight) { kept.budget.add(-weight, now.budget.amounts()); });
    now.budget.clear();
  }

  void record_step(double dt) {
    march.advance(dt);
    last = watch.check(now, dt, last, problem->take_cut());
    budget = now.budget.amounts();
    if (!march.starting()) losses.after_step(march.step(), march.t(), dt, state);
    if (config.time.steady) last.change = distance()(state, before) / dt;
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
    for (const double cut : last.cut) {
      warn_of_cut(setup, totals.largest_cut, cut);
      totals.largest_cut = std::max(totals.largest_cut, cut);
    }
  }

  /// The densities of the invariants at the ends of the whole mesh; nothing where a step failed, or a
  /// boundary has no condition for the state.
  std::vector<double> densities_at_surfaces() {
    if (inside_step) return {};
    std::vector<double> own;
    try {
      own = problem->densities_at_surfaces(march.t(), state);
    } catch (const error&) {
      return {};
    }
    return whole_ends(setup, own);
  }

  std::unique_ptr<run_setup> made;
  const run_setup& setup;
  const case_config& config;
  std::unique_ptr<semidiscrete_problem> problem;
  budgeted_problem budgeted;  ///< the problem with the budget of its surfaces
  std::unique_ptr<any_stepper<budgeted_problem>> integrator;
  monitor watch;
  stability_watch stability;
  rounding_bound rounding;
  budgeted_state now;
  field& state = now.unknowns;
  field before;                ///< before a step; empty without time.steady
  std::vector<double> budget;  ///< of the last step
  time_marcher<double> march;
  std::optional<step_controller<double>> control;
  std::optional<error_estimate<budgeted_problem>> estimate;  ///< with a tolerance
  std::optional<tolerance_forecast<double>> expected;
  std::optional<steady_solver> iteration;  ///< to the steady state, in place of steps
  bool found = false;                      ///< the steady state
  loss_watch losses;
  run_promises promises;
  step_record first, last;
  run_summary totals;
  double limiter_share = 1.0;  ///< of r Δt_FE
  bool inside_step = false;    ///< also after a step that failed
};

namespace {
std::vector<double> without_padding(const field& u) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(u.cells()) * static_cast<std::size_t>(u.components()));
  for (int cell = 0; cell < u.cells(); ++cell)
    values.insert(values.end(), u.row(cell), u.row(cell) + u.components());
  return values;
}

void copy_rows(const std::vector<double>& values, field& u) {
  for (int cell = 0; cell < u.cells(); ++cell)
    std::copy_n(values.data() + static_cast<std::ptrdiff_t>(cell) * u.components(), u.components(),
                u.row(cell));
}

void check_sizes(const run_setup& setup, const kept_value& saved, const field& u) {
  if (saved.unknowns.size() != static_cast<std::size_t>(u.cells()) * static_cast<std::size_t>(u.components()))
    throw input_error(
        "the saved state has another size than the case (it belongs to another case); restart with the case "
        "it was written for");
  if (!saved.budget.empty() && saved.budget.size() != size_of_whole_budget(setup))
    throw input_error(
        "the saved boundary budget has another size than that of the case (it belongs to another case); "
        "restart with the case it was written for");
}
}  // namespace

simulation::simulation(const case_config& config, const state_source& start,
                       const std::shared_ptr<communicator>& processes)
    : simulation(setup_that_fits(config, processes), start) {}
simulation::simulation(std::unique_ptr<run_setup> setup, const state_source& start)
    : impl_(std::make_unique<impl>(std::move(setup), start)) {}
simulation::~simulation() = default;
simulation::simulation(simulation&&) noexcept = default;
simulation& simulation::operator=(simulation&&) noexcept = default;

const case_config& simulation::config() const {
  return impl_->config;
}
const run_setup& simulation::setup() const {
  return impl_->setup;
}
const run_promises& simulation::promises() const {
  return impl_->promises;
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
  // With a tolerance the first step resolves the layer; later ones have the forecast length.
  if (step() == 0 && impl_->expected) return impl_->march.steps_left(impl_->expected->dt);
  return step() + impl_->march.steps_left(impl_->march.starting() ? impl_->limit() : impl_->proposed());
}
long simulation::snapshot_times_passed() const {
  const double every = config().output.every;
  return every > 0.0 ? multiples_until(t(), every) : 0;
}
bool simulation::next_step_depends_on_end() const {
  // Far from the end the answer is no without evaluating Δt_FE: no rule makes steps 32 times longer.
  constexpr double longest = 32.0 * time_marcher<double>::shared_steps;
  if (impl_->iteration) return false;
  const bool far = step() > 0 && !impl_->march.starting() && config().time.end - t() > longest * last().dt;
  if (far || finished()) return false;
  return impl_->march.shaped_by_end(impl_->proposed());
}
double simulation::limiter_share() const {
  return impl_->limiter_share;
}

double simulation::expected_loss() const {
  return impl_->losses.expected();
}
double simulation::expected_plateau() const {
  return impl_->expected ? impl_->expected->error : 0.0;
}
bool simulation::finished() const {
  return impl_->iteration ? impl_->found : impl_->march.done() || impl_->steady();
}

const step_record& simulation::advance() {
  const auto start = std::chrono::steady_clock::now();
  const double cpu = thread_seconds();
  impl& run = *impl_;
  run.inside_step = true;
  try {
    if (run.iteration)
      run.iterate();
    else
      run.record_step(run.step());
    run.inside_step = false;
  } catch (const numerical_error& failure) {
    const numerical_error here =
        failure.site().step >= 0 ? failure : failure.at(run.march.step() + 1, run.march.t());
    if (run.control || run.iteration) throw here;
    throw naming_instability(here, run.setup, run.next_dt());
  }
  run.totals.wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  run.totals.cpu_s += thread_seconds() - cpu;
  if (run.iteration) {
    run.watch.watch_velocities(run.state, run.last, run.totals);
    return run.last;
  }
  // An instability is the cause of the promises that it breaks.
  try {
    run.stability.add(run.last);
  } catch (const numerical_error& failure) {
    throw failure.at(run.last.step, run.last.t);
  }
  check_promises(run.promises, run.last, run.setup, run.rounding);
  run.watch.watch_velocities(run.state, run.last, run.totals);
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
                      (impl_->iteration ? 1.0 : static_cast<double>(impl_->setup.stages_of_step()));
  summary.t = t();
  summary.startup_steps = impl_->march.startup_steps();
  summary.point_stages_per_s = summary.wall_s > 0.0 ? work / summary.wall_s : 0.0;
  return summary;
}

field_table simulation::fields() const {
  return compute_fields(impl_->setup, impl_->state);
}

std::vector<surface_table> simulation::surfaces() const {
  if (config().output.surfaces.empty()) return {};
  const std::vector<double> budget = whole_budget(impl_->setup, impl_->budget),
                            densities = impl_->densities_at_surfaces();
  if (!processes().is_root()) return {};
  return compute_surfaces(impl_->setup, {t(), last().dt, budget, densities});
}

const grid& simulation::mesh() const {
  return impl_->setup.whole_mesh();
}
communicator& simulation::processes() const {
  return impl_->setup.processes();
}

std::vector<double> simulation::state() const {
  return without_padding(impl_->state);
}

std::vector<double> simulation::whole_state() const {
  return gather_cells(impl_->setup.builder(), state(), impl_->state.components());
}

std::span<const double> simulation::row(int cell) const {
  return {impl_->state.row(cell), static_cast<std::size_t>(impl_->state.components())};
}

std::vector<double> simulation::exact_state() const {
  const auto exact = impl_->setup.exact_state(t());
  return exact ? without_padding(*exact) : std::vector<double>{};
}

std::vector<double> simulation::epsilon() const {
  return gather_cells(impl_->setup.builder(), impl_->setup.epsilon_at_centres());
}

run_state simulation::save() const {
  run_state saved;
  saved.unknowns = state();
  saved.march = impl_->march.save();
  if (impl_->control) saved.control = impl_->control->save();
  if (impl_->iteration) saved.steady = steady_progress{impl_->iteration->reference()};
  saved.history = impl_->integrator->save();
  impl_->integrator->visit_kept([&](const budgeted_state& kept, double) {
    saved.kept.push_back({without_padding(kept.unknowns), whole_budget(impl_->setup, kept.budget.amounts())});
  });
  saved.totals = summary();
  // Times that every process measures are those of the root.
  std::array<double, 2> seconds = {saved.totals.wall_s, saved.totals.cpu_s};
  processes().broadcast(std::as_writable_bytes(std::span(seconds)));
  saved.totals.wall_s = seconds[0];
  saved.totals.cpu_s = seconds[1];
  saved.initial = impl_->first;
  saved.last = impl_->last;
  saved.budget = whole_budget(impl_->setup, impl_->budget);
  return saved;
}

void simulation::restore(const run_state& saved) {
  field& state = impl_->state;
  check_sizes(impl_->setup, {saved.unknowns, saved.budget}, state);
  for (const kept_value& kept : saved.kept) check_sizes(impl_->setup, kept, state);
  copy_rows(saved.unknowns, state);
  impl_->watch.forget_steps();
  // Before the first step the marcher is that of the case.
  if (saved.march.step > 0) impl_->march.resume(saved.march);
  if (impl_->control && saved.control) impl_->control->resume(*saved.control);
  if (impl_->iteration && saved.steady) impl_->iteration->set_reference(saved.steady->reference);
  if (saved.history) {
    impl_->integrator->restore(*saved.history, impl_->now);
    std::size_t k = 0;
    impl_->integrator->visit_kept([&](budgeted_state& kept, double) {
      if (k == saved.kept.size())
        throw io_error(
            "the checkpoint lacks values of earlier steps (damaged file); give another checkpoint");
      const kept_value& value = saved.kept[k++];
      copy_rows(value.unknowns, kept.unknowns);
      kept.budget = boundary_budget(own_budget(impl_->setup, value.budget));
    });
  }
  impl_->totals = saved.totals;
  impl_->first = saved.initial;
  impl_->last = saved.last;
  impl_->budget = own_budget(impl_->setup, saved.budget);
  impl_->now.budget = boundary_budget(impl_->budget);  // the next step shifts those of kept values by it
}

}  // namespace apsis
