#include <apsis/steady/internal/moment_correction.hpp>

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace apsis {
namespace {

/// A new J is built if a moment has changed by more than this part of its scale.
constexpr double change_for_new_system = 0.1;
/// Such a change no longer matters if the residual is below this part of that of the start.
constexpr double share_to_keep_system = 0.01;
/// A new J is built if the residual has grown by this factor since the last build.
constexpr double growth_for_new_system = 10.0;
/// A new J is built if the pseudo-time term of J is this many times the current one.
constexpr double change_of_pseudo_rate = 10.0;

}  // namespace

moment_correction::moment_correction(const relaxation_model& equation, const problem_builder& space,
                                     const cell_links& links, const cell_measures& cells,
                                     const steady_residual& start, bool first_order)
    : cells_(cells),
      system_(equation, space, links, first_order),
      totals_(cells.sums(start.omega)),
      changes_(start.omega.size()) {}

void moment_correction::note_residual(double residual) {
  if (!damped_.note_residual(residual)) return;
  if (holds_neutral_mode_)
    throw steady_imbalance(
        fmt::format(
            "no steady state is found: the residual stays at {:.2g} of that of the start (a front has no "
            "position at which the fluxes of the ends are equal, or no end fixes the pressure); give the "
            "ends "
            "states with equal fluxes, an outlet 'pressure', more velocities, or a larger steady.tolerance",
            residual),
        residual);
  forget_system();
}

void moment_correction::find(const steady_residual& of, double residual) {
  solve(of, residual);
  if (!damped_.note_change(size_)) return;
  forget_system();
  solve(of, residual);
}

void moment_correction::solve(const steady_residual& of, double residual) {
  build_system_if_due(of, residual);
  std::vector<double> missing = cells_.sums(of.omega);
  for (std::size_t i = 0; i < missing.size(); ++i) missing[i] = totals_[i] - missing[i];
  changes_ = system_.solve(of.of_transport, missing);
  size_ = cells_.largest_relative_change(of.omega, changes_);
}

void moment_correction::restart(int strength) {
  damped_ = damping(strength);
  lowest_ = pseudo_rate_ = 0.0;
  holds_neutral_mode_ = false;
  forget_system();
}

void moment_correction::forget_system() {
  built_ = false;
  seeks_neutral_mode_ = true;
  has_other_images_ = true;
}

bool moment_correction::is_due(const steady_residual& of, double residual) const {
  const double rate = flight_rate_ * std::max(damped_.vanishing_rate(residual), damped_.constant_rate());
  return !built_ || residual > growth_for_new_system * lowest_ ||
         pseudo_rate_ > change_of_pseudo_rate * rate ||
         (residual > share_to_keep_system && change_since_system(of.omega) > change_for_new_system);
}

void moment_correction::build_system_if_due(const steady_residual& of, double residual) {
  const bool due = is_due(of, residual);
  lowest_ = due ? residual : std::min(lowest_, residual);
  if (!due) {
    kept_ = true;
    return;
  }
  omega_of_system_ = of.omega;
  // A neutral mode responds strongly to any change. If it is the cause, nothing else needs damping.
  const double constant = flight_rate_ * damped_.constant_rate();
  pseudo_rate_ = 0.0;
  holds_neutral_mode_ = constant > 0.0 && seeks_neutral_mode_ && system_.build(of.omega, of.rates, 0.0, true);
  if (constant > 0.0) seeks_neutral_mode_ = holds_neutral_mode_;  // sought once for each term
  if (!holds_neutral_mode_) {
    pseudo_rate_ = std::max(flight_rate_ * damped_.vanishing_rate(residual), constant);
    system_.build(of.omega, of.rates, pseudo_rate_);
  }
  if (built_ && kept_) has_other_images_ = true;
  built_ = true;
  kept_ = false;
}

double moment_correction::change_since_system(const std::vector<double>& omega) const {
  std::vector<double> change(omega);
  for (std::size_t k = 0; k < change.size(); ++k) change[k] -= omega_of_system_[k];
  return cells_.largest_relative_change(omega_of_system_, change);
}

}  // namespace apsis
