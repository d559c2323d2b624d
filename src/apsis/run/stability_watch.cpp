#include <apsis/run/stability_watch.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace apsis {
namespace {

bool limited(const run_setup& setup) {
  return setup.config().space.limiter == limiter_choice::positivity;
}

/// Returns the limit as a value of time.cfl, rounded down to two digits.
std::string rounded_down(double limit) {
  const double unit = std::pow(10.0, std::floor(std::log10(limit)) - 1.0);
  return fmt::format("{:g}", std::floor(limit / unit * (1.0 + 1e-9)) * unit);
}

}  // namespace

double cfl_number(const run_setup& setup, double dt) {
  const velocity_set& velocities = setup.equation->velocities();
  double fastest = 0.0;
  for (std::size_t j = 0; j < static_cast<std::size_t>(velocities.components()); ++j) {
    double rate = 0.0;
    for (int k = 0; k < setup.mesh().dimensions(); ++k)
      rate += std::abs(velocities.speeds(k)[j]) / setup.mesh().spacing(k);
    fastest = std::max(fastest, rate);
  }
  return dt * fastest;
}

std::string remedy_of_instability(const run_setup& setup, double dt) {
  const double number = cfl_number(setup, dt), limit = setup.stability_limit();
  if (number > limit)
    return fmt::format(
        "CFL number {:.3g}; the linear stability limit of '{}' with '{}' is {:.3g}); use "
        "time.cfl = {} or less",
        number, setup.integrator_name(), setup.config().space.reconstruction, limit,
        rounded_down(limit / number * dt / setup.cfl_length()));
  return fmt::format(
      "CFL number {:.3g}, within the linear stability limit {:.3g}); halve the step, and use "
      "space.reconstruction = \"upwind1\" if this does not help",
      number, limit);
}

numerical_error naming_instability(const numerical_error& failure, const run_setup& setup, double dt) {
  if (!setup.has_space() || !(cfl_number(setup, dt) > setup.stability_limit())) return failure;
  return numerical_error(fmt::format("the solution is lost to an instability ({}: {}",
                                     remedy_of_instability(setup, dt), failure.problem()),
                         failure.site());
}

void warn_of_unstable_steps(const run_setup& setup, double dt) {
  const double limit = setup.stability_limit(), r = setup.ssp_coefficient();
  if (!setup.has_space() || !std::isfinite(limit)) return;
  const case_config& config = setup.config();
  constexpr double hopeless = 0.1;
  if (config.time.safety && setup.step_coefficient() < r) {
    const std::string text = fmt::format(
        "time.safety is relative to the CFL number {:.4g}, the linear stability limit of '{}' with "
        "'{}' (shorter than its SSP coefficient {:.4g})",
        limit, setup.integrator_name(), config.space.reconstruction, r);
    if (limit < hopeless)
      log::warning(text + "; choose a method of order 3, or space.reconstruction = \"upwind1\"");
    else
      log::info(text);
  }
  if (setup.has_tolerance() || !(cfl_number(setup, dt) > limit * (1.0 + 1e-9))) return;
  log::warning(fmt::format("waves of some cells grow ({}{}", remedy_of_instability(setup, dt),
                           limited(setup) ? "; the limiter keeps them nonnegative, but not small" : ""));
}

void stability_watch::add(const step_record& step) {
  if (!setup_.has_space() || setup_.has_tolerance()) return;
  if (std::abs(step.dt - dt_) > 0.1 * dt_) begin_again();
  dt_ = step.dt;
  change_ += step.density_change / judged;
  turn_ += step.density_turn / judged;
  if (++steps_ < judged) return;
  judge();
  begin_again();
}

void stability_watch::begin_again() {
  steps_ = 0;
  change_ = turn_ = 0.0;
}

void stability_watch::judge() {
  constexpr double grown = 100.0, rounding = 1e-10, lost = 0.01;
  constexpr int lasting = 16;
  const bool alternates = turn_ > change_ && turn_ > rounding;
  in_a_row_ = alternates ? in_a_row_ + 1 : 0;
  const bool grew = calmest_ >= 0.0 && turn_ > grown * calmest_;
  const bool lasts = in_a_row_ >= lasting && cfl_number(setup_, dt_) > setup_.stability_limit();
  calmest_ = calmest_ < 0.0 ? turn_ : std::min(calmest_, turn_);
  if (!unstable_ && alternates && (grew || lasts)) {
    unstable_ = true;
    log::warning(fmt::format("the solution is unstable (it alternates from step to step, {}; {}",
                             grew ? "by 100 times more than before" : "and this does not decay",
                             remedy_of_instability(setup_, dt_)));
  }
  if (unstable_ && alternates && change_ > lost)
    throw numerical_error(
        fmt::format("the solution is lost to an instability: {:.2g} of a density alternates in every step {}",
                    change_, remedy_of_instability(setup_, dt_)));
}

}  // namespace apsis
