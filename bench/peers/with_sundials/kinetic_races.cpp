#include "kinetic_contest.hpp"
#include "kinetic_races.hpp"
#include "sundials_kinetic.hpp"

#include <apsis/config/discretization_of_case.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::peers {
namespace {

/// Returns the number of explicit Runge–Kutta steps at about the largest stable dt. On the negative real axis
/// stability limits dt to 2.51 times the smallest ε.
long explicit_steps(double end, double smallest_epsilon) {
  return static_cast<long>(std::ceil(end / (2.5 * smallest_epsilon)));
}

/// Sets the reference after comparison with a second solution. Returns their relative distance; throws
/// numerical_error unless it is below `allowed`.
double accept_reference(kinetic_task& task, const field& exact, const field& second, double allowed) {
  const double apart = kinetic_task::distance(second, exact);
  if (!(apart < allowed))
    throw numerical_error(
        fmt::format("the reference solutions differ by {:.2g} (the limit is {:.0e}); refine "
                    "their steps",
                    apart, allowed));
  task.set_reference(exact);
  return apart;
}

/// Computes the reference by an explicit method with small steps. Returns its distance from the solution of
/// an entirely different method. Even with steps below ε, implicit methods solve the same system on point
/// values only. On averages the collision acts at Gauss points that every stage reconstructs again.
double find_mixed_reference(kinetic_task& task, unknowns which, bool quick) {
  field exact, second;
  const long steps = explicit_steps(task.end(), 0.8e-5);
  task.run("ssprk-5-4", 2 * steps, true, 1e3, &exact);
  if (which != unknowns::averages) {
    task.run("ark-548-2", steps, true, 1e3, &second);
  } else {
    sundials_options tight;
    tight.linear = linear_solver::collision_only;
    tight.tuned = true;
    tight.nonlinear = 0.01;
    tight.rtol = quick ? 1e-5 : 1e-6;
    tight.atol = 1e-4 * tight.rtol;
    tight.seconds_allowed = 1e3;
    run_sundials(task, tight, &second);
  }
  return accept_reference(task, exact, second, which == unknowns::averages || quick ? 2e-6 : 1e-7);
}

/// Computes the reference by extrapolated Euler steps, which resolve the layer. Returns its distance from the
/// solution of a method of order 5 with small equal steps after a graded start.
double find_broadwell_reference(kinetic_task& task, bool quick) {
  const field exact = task.extrapolated(quick ? 1e-9 : 1e-11);
  field second;
  task.run("ark-548-2", quick ? 200 : 4000, true, 1e3, &second);
  return accept_reference(task, exact, second, quick ? 1e-6 : 1e-10);
}

/// Returns numbers of equal steps. The longest steps span four cells or ten relaxation times (the rate is ρ/ε
/// with ρ ≤ 5). Only methods of many stages are stable for these. All methods but ssprk-2-2 have errors below
/// 1e-8 with 1280 steps. Returns no numbers if the runs would exceed the time limit by far.
std::vector<long> explicit_steps_of_broadwell(double end, double epsilon) {
  std::vector<long> all;
  const long least = std::max(20L, explicit_steps(end, epsilon / 5.0));
  if (least > 100000) return all;
  for (long steps = least / 4; steps <= std::max(4 * least, 1280L); steps *= 2)
    for (long quarters = 4; quarters < 8; ++quarters) all.push_back(quarters * steps / 4);
  return all;
}

/// Reduces the settings to those of a smoke test.
void make_quick(kinetic_settings& choices) {
  choices.factors = {4.0};
  choices.tolerances = {1e-3};
  choices.fine = choices.few = choices.defaults = {{1e-3}, {1e-3}};
  if (!choices.implicit.rtol.empty()) choices.implicit = choices.fine;
  if (!choices.explicit_steps.empty()) choices.explicit_steps.resize(1);
  choices.seconds_ours = choices.seconds_others = 0.3;
}

const std::string kinetic_note =
    std::string(
        "The table shows CPU seconds of one thread for a given relative temporal error of f, in the 2-norm "
        "over all cells and velocities. Brackets contain the ratio to the best of Apsis with f ≥ 0 "
        "throughout. Columns `least` have the minimum of f after any step. Contestants are every IMEX "
        "method of the catalogue and extrapolated Euler steps. They take equal steps, and steps chosen by "
        "a tolerance. Other contestants take equal steps. They are ") +
    words_of_others +
    ". Runs of methods with an SSP coefficient count only with f ≥ 0 throughout. Each contestant is "
    "represented by the cheapest run that reaches the error, whatever its setting. All contestants use "
    "the same T and Q. ARKODE integrates T explicitly and Q/ε implicitly. Tuned runs deduce the "
    "implicit right-hand side and have 20 nonlinear iterations. They use the inverse of the linearized "
    "collision as preconditioner of GMRES or instead of GMRES. CVODE uses BDF and is tuned in the same "
    "way. Names with f ≥ 0 mark runs of ARKODE and CVODE with their constraint. Radau 5 has the "
    "control of RADAU5. A sparse solver factorizes its Newton matrices "
    "(bench/peers/radau_kinetic.cpp). A dash marks errors that no run reached in {:g} s. ";

}  // namespace

result_table race_on_mixed_regime(unknowns which, const std::vector<double>& errors,
                                  const settings& options) {
  const bool quick = options.quick;
  kinetic_task task(which == unknowns::points ? "paper/bgk-mixed-fd" : "paper/bgk-mixed",
                    which == unknowns::averages_at_centres
                        ? std::vector<std::string>{"space.collisions=centres"}
                        : std::vector<std::string>{},
                    quick ? 0.004 : 0.5);
  const double apart = find_mixed_reference(task, which, quick);
  kinetic_settings choices{
      .factors = by_octaves(32.0, 0.25),
      .tolerances = {1e-3, 1e-4, 1e-5, 1e-6},
      .fine = {{1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6}, {1e-3, 1e-4}},
      .few = {{1e-2, 1e-3, 1e-4}, {1e-3, 1e-4}},
      .defaults = {{1e-3}, {1e-3}},
      .implicit = {},
      .longest = 0.008,
      .explicit_methods = {"ssprk-3-3"},
      .explicit_steps = {explicit_steps(task.end(), 1e-5)},
  };
  // The Newton matrices of 6000 unknowns have several times as many entries on averages.
  if (which == unknowns::points && !quick) choices.implicit = {{1e-2}, {1e-3}};
  if (quick) make_quick(choices);
  contest all(errors, "s", true);
  enter_all(all, task, choices);
  // No other program preserves f ≥ 0 with collisions at centres.
  std::optional<kinetic_task> at_gauss_points;
  if (which == unknowns::averages_at_centres) {
    at_gauss_points.emplace("paper/bgk-mixed", std::vector<std::string>{}, task.end());
    find_mixed_reference(*at_gauss_points, unknowns::averages, quick);
    enter_constrained_and_explicit(all, *at_gauss_points, choices, ", Gauss points");
  }
  all.run(quick ? 0 : options.repeats, 3.0);
  result_table result;
  result.note =
      fmt::format(fmt::runtime(kinetic_note), choices.seconds_others) +
      fmt::format(
          "The contest uses the mixed-regime problem (40 cells, 150 velocities, {}) at t = {:g}. An explicit "
          "method computes the reference. The reference is accurate to {:.1e} by comparison with an implicit "
          "method. Radau 5 is entered on point values only. A step takes seconds there.",
          which == unknowns::points     ? "point values"
          : which == unknowns::averages ? "cell averages"
                                        : "cell averages that collide at centres",
          task.end(), apart);
  if (at_gauss_points)
    result.note +=
        " Names with \"Gauss points\" mark runs on averages that collide there. They are runs with the "
        "constraint f ≥ 0 and runs of an explicit method. They are compared with a reference of their own. "
        "They are entered because other programs keep f ≥ 0 at Gauss points only.";
  all.add_to(result, std::nullopt, false);
  result.data["reference_error"] = apart;
  result.data["end"] = task.end();
  return result;
}

result_table race_on_broadwell(const settings& options) {
  const bool quick = options.quick;
  const double end = 0.5;
  result_table result;
  result.title = "Broadwell's model: work and precision";
  double furthest = 0.0;
  for (const double epsilon :
       quick ? std::vector<double>{1e-2} : std::vector<double>{1.0, 1e-2, 1e-4, 1e-6}) {
    kinetic_task task("paper/broadwell",
                      {fmt::format("model.epsilon={:g}", epsilon), "space.cells=80",
                       discretization_override("finite-difference")},
                      end);
    furthest = std::max(furthest, find_broadwell_reference(task, quick));
    kinetic_settings choices{
        .factors = by_octaves(4.0, 1.0 / 32.0),
        .tolerances = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9},
        .fine = {two_per_decade(1e-2, 1e-10), {1.0, 1e-2}},
        .few = {two_per_decade(1e-2, 1e-8), {1e-2}},
        .defaults = {two_per_decade(1e-2, 1e-6), {1e-2}},
        .implicit = {two_per_decade(1e-2, 1e-10), {1.0, 1e-2}},
        .longest = 0.03,
        .explicit_methods = explicit_contestants(),
        .explicit_steps = explicit_steps_of_broadwell(end, epsilon),
        .seconds_ours = 0.1,
        .seconds_others = 0.4,
    };
    if (quick) make_quick(choices);
    contest all({1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}, "s", true);
    enter_all(all, task, choices);
    all.run(quick ? 0 : options.repeats, 1.0);
    all.add_to(result, epsilon, true);
    if (result.note.empty()) result.note = fmt::format(fmt::runtime(kinetic_note), choices.seconds_others);
  }
  result.note += fmt::format(
      "The contest uses Broadwell's model with the smooth data out of equilibrium of paper/broadwell. "
      "The problem has 80 cells and finite differences (WENO5-JS), and ends at t = {:g}. Extrapolated "
      "Euler steps of order 8 compute the reference. The reference is accurate to {:.1e} by comparison "
      "with ark-548-2. Explicit methods are entered for ε ≥ 1e-4.",
      end, furthest);
  result.data["reference_error"] = furthest;
  result.data["end"] = end;
  return result;
}

}  // namespace apsis::bench::peers
