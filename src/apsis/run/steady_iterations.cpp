#include <apsis/run/steady_iterations.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/run/ray_warning.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Number of marches before a failure is final, and length of the first one in times of flight
/// through the domain.
constexpr int most_marches = 3;
constexpr double flights_of_first_march = 5.0;

/// Returns the message without its advice, which is for a run in time.
std::string cause_of(const numerical_error& failure) {
  return failure.problem().substr(0, failure.problem().find("; "));
}

/// Warns about weights that may change without end. Limiters settle, and need no warning.
void warn_of_weights(const run_setup& setup) {
  if (!setup.has_space()) return;
  const auto& space = setup.config().space;
  if (const auto& scheme = find_reconstruction(space.reconstruction); !scheme.linear && !scheme.settles)
    log::warning(
        fmt::format("the iteration may never settle where f jumps along rays (the weights of {} depend "
                    "on f); write space.reconstruction = \"upwind5\" or \"weno5-z-smooth\"",
                    space.reconstruction));
}

}  // namespace

void steady_iterations::start() {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  run_.first.residual = run_.last.residual = {unknown};
  first_ = run_.state;
  make_solver();
  warn_of_weights(run_.setup);
  warn_of_rays(run_.setup, run_.problem->relaxation_time(0.0, run_.state));
  run_.problem->take_cut();  // discards that of the first residual
}

void steady_iterations::make_solver() {
  const auto& wanted = run_.config.steady_state;
  solver_.emplace(*run_.setup.equation->as_relaxation(), run_.setup.builder(), *run_.problem, run_.state,
                  steady_options{*wanted.tolerance, wanted.iterations, wanted.images});
  damping_ = 0;
}

void steady_iterations::advance() {
  try {
    steady_iteration done = easier_ ? follow_continuation() : march_ ? march() : iterate();
    run_.march.advance(1.0);
    try {
      record(done);
    } catch (const numerical_error& failure) {
      if (done.converged) throw;
      done = replace(failure);
      record(done);
    }
    found_ = done.converged;
    log_removed(done);
  } catch (const numerical_error& failure) {
    throw run_.located(failure);
  }
}

/// Takes another iteration if the last one is no start for the next. An example is a gas too hot
/// for the velocities.
steady_iteration steady_iterations::replace(const numerical_error& failure) {
  if (march_) throw failure;
  if (!easier_ && begin_again(failure)) return iterate();
  return recover(failure);
}

steady_iteration steady_iterations::iterate() {
  for (;;) {
    try {
      return solver_->iterate(run_.state);
    } catch (const steady_imbalance&) {
      throw;
    } catch (const steady_stall& stall) {
      if (!begin_continuation(stall, continuations_after(stall))) throw;
      return follow_continuation();
    } catch (const numerical_error& failure) {
      if (begin_again(failure)) continue;
      return recover(failure);
    }
  }
}

/// Takes the next iteration if no pseudo-time term helps: of a continuation, or else a part of a march.
steady_iteration steady_iterations::recover(const numerical_error& failure) {
  if (begin_continuation(failure)) return follow_continuation();
  begin_march(failure);
  return march();
}

/// Begins again from the first state with a stronger pseudo-time term. Returns false if there is no stronger
/// one, or after a march.
bool steady_iterations::begin_again(const numerical_error& failure) {
  if (marches_ > 0 || !solver_->begin_again()) return false;
  log::info(
      fmt::format("iteration {}: {}; begins again from the first state with a stronger pseudo-time term",
                  run_.march.step(), cause_of(failure)));
  run_.state = first_;
  return true;
}

/// Begins a continuation of easier problems from the first state. Returns false if none of the first
/// `allowed` continuations is left.
bool steady_iterations::begin_continuation(const numerical_error& failure, std::size_t allowed) {
  easier_.reset();
  while (!easier_ && tried_ < allowed)
    easier_ = make_continuation(tried_++, *run_.setup.equation->as_relaxation(), run_.setup.builder(), first_,
                                solver_->optical_length(), run_.config.steady_state.images);
  if (!easier_) return false;
  log::info(fmt::format("iteration {}: {}; {}, one after the other, give the next start", run_.march.step(),
                        cause_of(failure), easier_->name()));
  run_.state = first_;
  return true;
}

/// Takes one iteration of an easier problem. Its residual is that of the equation of the case.
steady_iteration steady_iterations::follow_continuation() {
  try {
    easier_->iterate(run_.state);
    return end_of_detour(easier_->finished());  // its state may have no equilibrium in the case
  } catch (const numerical_error& failure) {
    if (begin_continuation(failure)) return follow_continuation();
    begin_march(failure);
    return march();
  }
}

/// Begins a march in time, twice as long as the previous one.
void steady_iterations::begin_march(const numerical_error& failure) {
  if (marches_ == most_marches || !std::isfinite(solver_->flight_time())) throw failure;
  const double duration = std::ldexp(flights_of_first_march * solver_->flight_time(), marches_++);
  log::info(
      fmt::format("iteration {}: {}; steps in time from the first state until t = {:.3g} give the next start",
                  run_.march.step(), cause_of(failure), duration));
  run_.state = first_;
  march_.emplace(run_.setup, first_, duration);
}

/// Takes a part of the march, and returns its residual.
steady_iteration steady_iterations::march() {
  march_->advance(run_.state);
  return end_of_detour(march_->finished());
}

/// Returns the record of a step of a continuation or of a march. After the last one the solver begins anew.
steady_iteration steady_iterations::end_of_detour(bool finished) {
  steady_iteration done;
  done.residual = solver_->relative_residual(run_.state);
  done.change = std::numeric_limits<double>::quiet_NaN();
  if (finished) {
    damping_ = easier_ ? easier_->damping() : 0;
    easier_.reset();
    march_.reset();
    solver_->restart(damping_);
  }
  return done;
}

void steady_iterations::check() {
  if (found_ || !run_.march.done()) return;
  throw numerical_error(
      fmt::format("no steady state in {} iterations (residual {:.2g}, change of the moments {:.2g}); give a "
                  "larger steady.iterations, or march in time",
                  run_.config.steady_state.iterations, run_.last.residual.front(), run_.last.change),
      {run_.last.step, run_.last.t});
}

void steady_iterations::log_damping(int damping) {
  if (damping > damping_)
    log::info(
        fmt::format("iteration {}: a {}pseudo-time term damps the corrections (they are too large, or the "
                    "residual does not "
                    "fall)",
                    run_.march.step(), damping_ == 0 ? "" : "stronger "));
  damping_ = damping;
}

void steady_iterations::log_removed(const steady_iteration& done) {
  if (const removed_values& removed = done.removed; done.converged && removed.count > 0)
    log::info(fmt::format(
        "{} values below 0, the smallest {:.2g}, are set to 0 with the moments of their cells kept; "
        "the residual is then {:.2g}",
        removed.count, removed.lowest, done.residual));
}

void steady_iterations::record(const steady_iteration& done) {
  log_damping(done.damping);
  const std::span<const double> rates = run_.problem->budget_rates();
  run_.now.budget = boundary_budget({rates.begin(), rates.end()});
  run_.budget = run_.now.budget.amounts();
  step_record& last = run_.last;
  last = run_.watch.check(run_.now, 1.0, last, run_.problem->take_cut());
  last.change = done.change;
  last.residual = {done.residual};
  last.removed = done.removed;
  last.received = run_.first.received;
  last.entropy_change = std::numeric_limits<double>::quiet_NaN();
  set_net_rates();
  run_.record_position(1.0);
  // Earlier iterates are not part of the result.
  run_summary& totals = run_.totals;
  totals.min_value = last.min_value;
  totals.negative_values = last.negative_values;
  totals.conservation_defect = 0.0;
  for (const double rate : last.conservation_defect)
    totals.conservation_defect = std::max(totals.conservation_defect, rate);
  for (const double cut : last.cut) totals.largest_cut = cut;
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  totals.velocity_room = totals.velocity_resolution = unlimited;
  totals.velocity_beyond = totals.velocity_missed = totals.velocity_needed = 0.0;
  run_.watch.watch_velocities(run_.state, last, totals);
}

void steady_iterations::set_net_rates() {
  step_record& last = run_.last;
  const std::size_t count = last.total.size();
  std::vector<double> scales(count);
  run_.setup.equation->invariant_scales(last.total, scales.data());
  for (std::size_t k = 0; k < count; ++k) {
    double net = 0.0;
    for (std::size_t n = k; n < last.flux.size(); n += count) net += last.flux[n];
    last.conservation_defect[k] = scales[k] > 0.0 ? std::abs(net) / scales[k] : std::abs(net);
  }
  last.defect_of_step = last.conservation_defect;
}

void steady_iterations::save(run_state& saved) const {
  saved.steady = steady_progress{solver_->reference()};
}

void steady_iterations::restore(const run_state& saved) {
  if (saved.steady) solver_->set_reference(saved.steady->reference);
  first_ = run_.state;
}

}  // namespace apsis
