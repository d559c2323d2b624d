#include <apsis/integrate/rate_loss.hpp>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr double large_error = 1e-3, small_error = 1e-5;
/// Largest harmless error of the moments, as a part of all their changes.
constexpr double large_part = 0.1;
/// A method is fit where its terms of size ε are wrong by less than this part.
constexpr double fit_part = 0.05;

std::string percent(double error, double of) {
  return of > 0.0 ? fmt::format("{:.0f} %", 100.0 * error / of) : "0 %";
}

}  // namespace

loss_verdict judge_loss(const rate_loss<double>& loss, double done, double rest,
                        std::optional<double> tolerance) {
  const bool wrong_rate = loss.rate > fit_part * loss.diffusion;
  const double rate = wrong_rate ? loss.rate : 0.0,
               result = loss.result > fit_part * loss.deviation ? loss.result : 0.0;
  const double horizon = std::min(rest, 1.0 / std::max(loss.change, 1e-300));
  const double moments = done + loss.layer + rate * horizon;
  loss_verdict verdict;
  verdict.rate = rate;
  verdict.expected = std::min(1.0, moments + result);
  const bool main_part = rate > large_part * loss.change && moments > small_error;
  verdict.large = main_part || verdict.expected > std::max(large_error, 30.0 * tolerance.value_or(0.0));
  return verdict;
}

std::string describe_loss(const std::string& method, const rate_loss<double>& loss, double t, double dt,
                          double end, double expected) {
  return fmt::format(
      "method '{}' is unfit for steps of {:.2g} at t = {:.3g} (of the terms of size epsilon, those that "
      "transport moments, such as viscosity, are wrong by {}, and the deviation from equilibrium by {}{}; "
      "estimated relative error until t = {:g}: {:.1g})",
      method, dt, t, percent(loss.rate, loss.diffusion), percent(loss.result, loss.deviation),
      loss.layer > large_part * expected ? "; the initial layer is not resolved" : "", end, expected);
}

}  // namespace apsis
