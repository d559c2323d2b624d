#include <apsis/run/promises.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/run/stability_watch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {

std::string run_promises::text() const {
  std::vector<std::string> kept;
  if (positivity) kept.emplace_back("positivity");
  if (conservation) kept.emplace_back("conservation");
  if (entropy) kept.emplace_back("entropy decay");
  if (!condition.empty()) kept.push_back(condition);
  const std::string promised = kept.empty()
                                   ? "nothing is promised for this configuration; everything is reported"
                                   : fmt::format("promised at every step: {}", fmt::join(kept, ", "));
  return why_signed.empty() ? promised : fmt::format("{}; {}", promised, why_signed);
}

namespace {

bool takes_formula(const run_setup& setup) {
  const auto& velocity = setup.config().velocity;
  return velocity.points > 0 && velocity.equilibrium == equilibrium_choice::formula;
}

[[noreturn]] void broken(const std::string& promise, const step_record& last, double value) {
  throw numerical_error("broken promise: " + promise, {last.step, last.t, -1, value});
}

/// Returns the likely cause of a change beyond rounding in a conserved quantity, with a remedy.
std::string reason_of_defect(const step_record& last, const run_setup& setup, double allowed) {
  if (takes_formula(setup))
    return "(the velocity grid became too coarse for the Maxwellian by formula); use "
           "velocity.equilibrium = \"auto\"";
  if (setup.has_space() && cfl_number(setup, last.dt) > setup.stability_limit())
    return "because the steps are unstable " + remedy_of_instability(setup, last.dt);
  if (setup.equation->positive() && last.negative_values > 0)
    return fmt::format(
        "(large values of both signs cancel: {} are negative, as happens beyond the step that strong "
        "stability allows); use space.limiter = \"positivity\" and time.safety = 1",
        last.negative_values);
  return fmt::format("(a step of {} explains {:.2g}: some equilibrium has other moments than the state); {}",
                     setup.integrator_name(), allowed,
                     setup.config().velocity.points > 0
                         ? "use velocity.equilibrium = \"discrete\", or more velocity.points"
                         : "check the moments of the equilibrium of the model");
}

}  // namespace

bool conserves_to_rounding(const run_setup& setup, const field& initial, const rounding_bound& rounding) {
  const double defect = setup.equilibrium_defect(initial);
  if (defect <= rounding.of_sums) return true;  // two sums over the components may differ this much
  log::warning(fmt::format(
      "collisions do not conserve to rounding (the moments of the equilibrium miss those of the initial data "
      "by {:.2g}, so that conservation and entropy decay are not promised){}",
      defect, takes_formula(setup) ? "; use velocity.equilibrium = \"auto\"" : ""));
  return false;
}

void warn_of_cut(const run_setup& setup, double largest, double cut) {
  if (largest > harmless_cut || !(cut > harmless_cut)) return;
  std::string moment = setup.equation->cut_moment();
  std::replace(moment.begin(), moment.end(), '_', ' ');
  const bool published = !setup.equation->collisions_keep_sign();
  log::warning(fmt::format(
      "the rate at which the {} relaxes is changed by {:.2g} times its value in some cell ({}); {}", moment,
      cut,
      published ? "the velocities do not resolve its target there"
                : "its target is cut off where the solution would be negative",
      published ? "use more velocities" : "use model.tails = \"signed\" for the model as published"));
}

void check_promises(const run_promises& promises, const step_record& last, const run_setup& setup,
                    const rounding_bound& rounding) {
  if (!promises.condition.empty() && last.violation)
    throw numerical_error("broken promise: " + last.violation->problem,
                          {last.step, last.t, last.violation->cell, last.violation->value});
  if (promises.positivity && last.negative_values > 0)
    broken(fmt::format("{} values are negative (the configuration entails positivity)", last.negative_values),
           last, last.min_value);
  // The bound of a run is the sum of the bounds of its steps.
  const double allowed = rounding.in_one_step();
  for (std::size_t k = 0; promises.conservation && k < last.defect_of_step.size(); ++k) {
    const double change = last.defect_of_step[k];
    if (!(change <= allowed))
      broken(fmt::format("{} is not conserved to rounding {}", setup.equation->invariants()[k],
                         reason_of_defect(last, setup, allowed)),
             last, change);
  }
  if (promises.entropy && last.entropy_change > 1e-13 * (1.0 + std::abs(last.entropy)))
    broken("the entropy increased by more than walls give (first-order upwind within r dt_FE entails decay)",
           last, last.entropy_change);
}

}  // namespace apsis
