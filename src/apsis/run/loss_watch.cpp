#include <apsis/run/loss_watch.hpp>

#include <apsis/config/method_of_case.hpp>
#include <apsis/core/log.hpp>
#include <apsis/exec/global_sum.hpp>
#include <apsis/exec/memory.hpp>
#include <apsis/run/memory_need.hpp>
#include <apsis/run/state_distance.hpp>

#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Responses below this bound count as exact.
constexpr double exact_response = 1e-9;
/// Number of state-sized buffers of an estimate.
constexpr int buffers_of_estimate = 10;
/// Least number of steps between estimates: one costs about three steps.
constexpr long steps_between = 64;

bool is_exact(const rate_response& of) {
  return rate_response::largest(of.flux) < exact_response && rate_response::largest(of.last) < exact_response;
}

bool has_memory_for(const run_setup& setup) {
  const double wanted = memory_need(setup, buffers_of_estimate).bytes();
  const double limit = available_memory().bytes;
  return global_lowest(setup.processes(), wanted < limit ? 1.0 : 0.0) > 0.0;
}

}  // namespace

loss_watch::loss_watch(const run_setup& setup, semidiscrete_problem& problem)
    : setup_(setup), problem_(problem) {
  if (!setup.equation->has_relaxation_time()) return;
  response_ = compute_rate_response(setup.config().time.method);
  if (response_ && problem_.collides_exactly()) implicit_ = setup.make_implicit_problem();
}

loss_watch::~loss_watch() = default;

std::optional<loss_watch::loss> loss_watch::estimate(double t, const field& u, double dt,
                                                     const rate_response& of, bool layer) {
  semidiscrete_problem& p = implicit_ ? *implicit_ : problem_;
  const auto distance = [&](const field& a, const field& b) {
    p.throw_late_errors();
    return relative_distance(a, b, setup_.processes(), setup_.runs_on());
  };
  return compute_rate_loss(p, t, u, dt, of, distance, layer);
}

void loss_watch::start(double t, const field& u, double dt, bool layer) {
  t_ = t;
  if (!response_ || !has_memory_for(setup_)) {
    response_.reset();
    return;
  }
  if (is_exact(*response_) && !layer) {
    response_.reset();
    return;
  }
  check(t, u, dt, layer);
}

void loss_watch::after_step(long step, double t, double dt, const field& u) {
  if (!response_ || warned_ || step < step_ + steps_between) return;
  if (step < 2 * step_ && dt < 2.0 * dt_) return;
  step_ = step;
  check(t, u, dt, false);
}

void loss_watch::check(double t, const field& u, double dt, bool layer) {
  const auto found = estimate(t, u, dt, *response_, layer);
  if (!found) return;
  done_ += rate_ * (t - t_) + found->layer;
  t_ = t;
  dt_ = dt;
  loss later = *found;
  later.layer = 0.0;  // counted in done_
  const loss_verdict verdict =
      judge_loss(later, done_, setup_.config().time.end - t, setup_.config().time.tolerance);
  rate_ = verdict.rate;
  expected_ = verdict.expected;
  if (verdict.large) warn(t, u, dt, layer, *found);
}

void loss_watch::warn(double t, const field& u, double dt, bool layer, const loss& found) {
  warned_ = true;
  log::warning(describe_loss(setup_.integrator_name(), found, t, dt, setup_.config().time.end, expected_) +
               "; " + remedy(t, u, dt, layer));
}

std::string loss_watch::remedy(double t, const field& u, double dt, bool layer) {
  std::string finer = fmt::format("give time.dt below {:.1g} to resolve the relaxation",
                                  0.1 * problem_.relaxation_time(t, u));
  // On a mesh, given steps need a method with a step bound. The rows that preserve bounds have such methods.
  std::vector<std::string> names = {choose_method(request_of(setup_.config())).method};
  for (const choice_row& row : choice_table())
    if (!row.longest_steps && (row.signs.value_or(true) || (!setup_.has_space() && !row.explicit_method)))
      names.push_back(row.method);
  std::string best;
  double least = expected_ / 10.0;  // a suggested method must lose ten times less
  for (const std::string& name : names) {
    if (!best.empty() || name == setup_.integrator_name()) continue;
    const auto of = compute_rate_response(name);
    const auto other = of ? estimate(t, u, dt, *of, layer) : std::nullopt;
    if (!other) continue;
    const double left = judge_loss(*other, 0.0, setup_.config().time.end - t, {}).expected;
    if (left >= least) continue;
    least = left;
    best = name;
  }
  if (best.empty()) return finer;
  return fmt::format("choose time.method = \"{}\", or {}", best, finer);
}

}  // namespace apsis
