#include <apsis/steady/damping.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace apsis {
namespace {

struct term {
  double of_residual,  ///< factor of the relative residual: vanishes in the steady state
      constant;        ///< for cases in which that is not enough
};
/// Terms from weak to strong. A stronger term costs additional iterations if a weaker one suffices.
constexpr std::array<term, 5> terms = {{{0.0, 0.0}, {0.3, 0.0}, {30.0, 0.0}, {30.0, 3.0}, {100.0, 10.0}}};

/// Iterations without progress until the next term is selected.
constexpr int short_patience = 35;
/// Corrections that are too large until the next term is selected.
constexpr int most_large_corrections = 12;
/// Below this relative residual, terms that vanish with it are skipped.
constexpr double share_for_constant_term = 0.01;
/// Iterations without progress with the strongest term until the iteration stops.
constexpr int patience = 100;

}  // namespace

damping::damping(int strength) : strength_(static_cast<std::size_t>(std::min(strength, strongest()))) {}

int damping::strongest() {
  return static_cast<int>(terms.size()) - 1;
}

double damping::vanishing_rate(double residual) const {
  return terms[strength_].of_residual * std::min(residual, 1.0);
}
double damping::constant_rate() const {
  return terms[strength_].constant;
}

void damping::strengthen(double residual) {
  ++strength_;
  while (strength_ + 1 < terms.size() && residual < share_for_constant_term &&
         terms[strength_].constant == 0.0)
    ++strength_;
  best_ = infinite;
  idle_ = large_corrections_ = 0;
}

bool damping::note_residual(double residual) {
  ++idle_;
  if (residual < 0.9 * best_) {
    best_ = residual;
    idle_ = 0;
  }
  if (strength_ + 1 < terms.size() &&
      (idle_ > short_patience || large_corrections_ > most_large_corrections)) {
    strengthen(residual);
    return true;
  }
  if (idle_ > patience)
    throw steady_stall(
        fmt::format(
            "no steady state is found: the residual stays at {:.2g} of that of the start for {} "
            "iterations (nonlinear weights of a reconstruction or limits of slopes may never settle, nor "
            "flows "
            "without a steady state); use upwind5 or weno5-z-smooth, give a larger tolerance, or march in "
            "time",
            best_, patience),
        best_);
  return false;
}

bool damping::note_change(double change) {
  if (!(change > largest_change)) return false;
  ++large_corrections_;
  if (strength_ > 0) return false;
  strengthen(infinite);
  return true;
}

}  // namespace apsis
