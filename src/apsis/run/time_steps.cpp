#include <apsis/run/time_steps.hpp>

#include <apsis/config/method_of_case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/method/step_law.hpp>
#include <apsis/run/promises.hpp>
#include <apsis/run/ray_warning.hpp>
#include <apsis/run/state_distance.hpp>
#include <apsis/run/step_plan.hpp>
#include <apsis/run/whole_budget.hpp>

#include <algorithm>
#include <cmath>

namespace apsis {
namespace {

const field& unknowns_of(const field& u) {
  return u;
}
const field& unknowns_of(const budgeted_state& u) {
  return u.unknowns;
}

}  // namespace

time_steps::time_steps(running_case& run)
    : run_(run),
      budgeted_(*run.problem),
      integrator_(
          make_stepper(run.setup.integrator(), budgeted_,
                       run.setup.has_tolerance() ? solutions::result_and_embedded : solutions::result)),
      stability_(run.setup),
      losses_(run.setup, *run.problem) {
  if (run.setup.has_tolerance()) {
    const auto& of_one_step = *integrator_->one_step();  // the setup refuses others
    control_.emplace(*run.config.time.tolerance, estimate_of(run.setup.integrator().starter()).order,
                     find_step_law(run.config.time.controller));
    estimate_.emplace(of_one_step.weight_of_estimate(), of_one_step.resolves_collisions());
  }
  limit_for_steps();
}

void time_steps::start() {
  if (run_.march.done()) return;
  const double relaxation = run_.problem->relaxation_time(run_.march.t(), run_.state);
  warn_before_steps(relaxation);
  // The first step may be shorter than those that follow.
  run_.setup.decide_promises(run_.promises, limit(), forward_euler_limit(), run_.first.negative_values == 0,
                             conserves_to_rounding(run_.setup, run_.state, run_.rounding));
  start_steps(relaxation);
  start_watch();
  run_.problem->take_cut();  // discards that of steps that were only tried
}

void time_steps::warn_before_steps(double relaxation) {
  warn_of_dense_stages(run_.setup);
  warn_of_stiff_collision(run_.setup, relaxation, next_dt());
  warn_of_fast_source(run_.problem->growth_of_source(run_.march.t(), run_.state), next_dt());
  warn_of_unstable_steps(run_.setup, next_dt());
  warn_of_moved_steady_state(run_.setup, relaxation, next_dt());
  warn_of_rays(run_.setup, relaxation);
}

/// Returns a function that computes ‖u − v‖₂/‖u‖₂. It first throws errors that processes met while
/// they computed u and v.
auto time_steps::distance() {
  return [this](const auto& u, const auto& v) {
    run_.problem->throw_late_errors();
    return relative_distance(unknowns_of(u), unknowns_of(v), run_.setup.processes(), run_.setup.runs_on());
  };
}

void time_steps::start_steps(double relaxation) {
  const run_setup& setup = run_.setup;
  if (control_) {
    const double longest = std::min(limit(), run_.config.time.end);
    warn_of_tolerance(longest, relaxation);
    const auto rule = step_rule<double>::unlimited().with(
        setup.has_graded_start() ? startup::graded : startup::none, run_.config.time.startup_growth);
    start_control(*run_.problem, run_.march.t(), run_.state, longest, rule, *control_, distance());
    warn_of_layer(setup, *run_.problem, run_.state, relaxation, control_->proposed());
  } else if (setup.has_graded_start()) {
    run_.march.start_up(limit(), relaxation);
  }
}

void time_steps::warn_of_tolerance(double longest, double relaxation) {
  const run_setup& setup = run_.setup;
  if (setup.integrator().starter().kind == method_kind::explicit_only) return;  // resolves the relaxation
  const auto bounds = compute_plateau_bounds(to_butcher(setup.integrator().form));
  expected_ = forecast_tolerance(*integrator_->one_step(), run_.march.t(), run_.now, run_.config.time.end,
                                 longest, control_->target(), bounds, distance());
  warn_of_plateau(setup, *expected_, relaxation);
}

/// Starts the estimate of the loss in the usual steps. A forecast above the tolerance has
/// already been reported.
void time_steps::start_watch() {
  const double dt = expected_ ? expected_->dt : limit();
  if (expected_ && expected_->error > *run_.config.time.tolerance) return;
  const bool layer = !control_ && !run_.setup.has_graded_start();
  losses_.start(run_.march.t(), run_.state, std::min(dt, run_.config.time.end - run_.march.t()), layer);
}

/// Limits the problem for the steps of the case. Steps known to be shorter than the longest need
/// less of the limiter.
void time_steps::limit_for_steps() {
  if (control_) return;
  limiter_share_ =
      run_.problem->share_of_longest_step(run_.setup.ssp_coefficient(), limit(), run_.march.t(), run_.state);
  run_.problem->limit_for_steps(limiter_share_);
}

double time_steps::forward_euler_limit() {
  return run_.setup.ssp_coefficient() * run_.problem->forward_euler_step(run_.march.t(), run_.state);
}

/// Returns the step limit of the case.
double time_steps::limit() {
  const auto& time = run_.config.time;
  if (time.cfl) return *time.cfl * run_.setup.cfl_length();
  if (time.safety)
    return *time.safety *
           (run_.setup.step_coefficient() * run_.problem->forward_euler_step(run_.march.t(), run_.state));
  return run_.march.fixed_dt().value_or(*time.dt);
}

double time_steps::proposed() {
  return control_ ? std::min(limit(), control_->proposed()) : limit();
}

bool time_steps::finished() const {
  const auto& steady = run_.config.time.steady;
  return run_.march.done() || (steady && run_.last.change <= *steady);
}

long time_steps::steps_left() {
  // With a tolerance the first step resolves the layer; later ones have the forecast length.
  if (run_.march.step() == 0 && expected_) return run_.march.steps_left(expected_->dt);
  return run_.march.steps_left(run_.march.starting() ? limit() : proposed());
}

bool time_steps::next_step_depends_on_end() {
  // Far from the end, returns false without an evaluation of Δt_FE: no rule makes steps 32 times longer.
  constexpr double longest = 32.0 * time_marcher<double>::shared_steps;
  const time_marcher<double>& march = run_.march;
  const bool far =
      march.step() > 0 && !march.starting() && run_.config.time.end - march.t() > longest * run_.last.dt;
  if (far || finished()) return false;
  return march.shaped_by_end(proposed());
}

void time_steps::advance() {
  try {
    record(step());
  } catch (const numerical_error& failure) {
    if (control_) throw run_.located(failure);
    throw naming_instability(run_.located(failure), run_.setup, next_dt());
  }
}

/// u ← u^{n+1}; returns Δt.
double time_steps::step() {
  begin_budget();
  if (run_.config.time.steady) before_ = run_.state;
  if (control_)
    return step_within_tolerance(*integrator_->one_step(), run_.march, *control_, *estimate_, limit(),
                                 run_.now, distance());
  const double dt = next_dt();
  integrator_->step(run_.march, dt, run_.now);
  return dt;
}

/// Begins the budget of a step. Budgets of kept values, which are sums of earlier u, are shifted by the
/// amounts that u received in the last step.
void time_steps::begin_budget() {
  integrator_->visit_kept(
      [this](budgeted_state& kept, double weight) { kept.budget.add(-weight, run_.now.budget.amounts()); });
  run_.now.budget.clear();
}

void time_steps::record(double dt) {
  step_record& last = run_.last;
  run_summary& totals = run_.totals;
  run_.march.advance(dt);
  last = run_.watch.check(run_.now, dt, last, run_.problem->take_cut());
  run_.budget = run_.now.budget.amounts();
  if (!run_.march.starting()) losses_.after_step(run_.march.step(), run_.march.t(), dt, run_.state);
  if (run_.config.time.steady) last.change = distance()(run_.state, before_) / dt;
  run_.record_position(dt);
  totals.min_value = std::min(totals.min_value, last.min_value);
  totals.negative_values += last.negative_values;
  for (const double defect : last.conservation_defect)
    totals.conservation_defect = std::max(totals.conservation_defect, defect);
  if (!std::isnan(last.entropy_change))
    totals.max_entropy_increase = std::max(totals.max_entropy_increase, last.entropy_change);
  for (const double cut : last.cut) {
    warn_of_cut(run_.setup, totals.largest_cut, cut);
    totals.largest_cut = std::max(totals.largest_cut, cut);
  }
}

void time_steps::check() {
  // Checked first, because an instability is the cause of the promises that it breaks.
  try {
    stability_.add(run_.last);
  } catch (const numerical_error& failure) {
    throw failure.at(run_.last.step, run_.last.t);
  }
  check_promises(run_.promises, run_.last, run_.setup, run_.rounding);
}

void time_steps::save(run_state& saved) const {
  if (control_) saved.control = control_->save();
  saved.history = integrator_->save();
  integrator_->visit_kept([&](const budgeted_state& kept, double) {
    saved.kept.push_back({without_padding(kept.unknowns), whole_budget(run_.setup, kept.budget.amounts())});
  });
}

void time_steps::restore(const run_state& saved) {
  if (control_ && saved.control) control_->resume(*saved.control);
  if (!saved.history) return;
  integrator_->restore(*saved.history, run_.now);
  std::size_t k = 0;
  integrator_->visit_kept([&](budgeted_state& kept, double) {
    if (k == saved.kept.size())
      throw io_error("the checkpoint lacks values of earlier steps (damaged file); give another checkpoint");
    const kept_value& value = saved.kept[k++];
    copy_rows(value.unknowns, kept.unknowns);
    kept.budget = boundary_budget(own_budget(run_.setup, value.budget));
  });
}

}  // namespace apsis
