#include "mixed.hpp"
#include "mixed_contest.hpp"
#include "sundials_mixed.hpp"

#include <apsis/method/certificate.hpp>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::peers {
namespace {

using integrator = sundials_options::integrator;

/// Time limits of a run in seconds; the fastest runs need a fiftieth of it.
struct limits {
  double others = 10.0, ours = 5.0;
};
limits time_limit;

/// Equal steps of the given multiples of the longest step with f ≥ 0, or of that of forward Euler for methods
/// without an SSP coefficient.
void add_ours(contest& all, mixed_regime& what, const method& m, const std::vector<double>& factors,
              const std::vector<double>& tolerances) {
  const bool ssp = find_certificate(m.name).ssp_coefficient > 0;
  for (const double factor : factors)
    for (const bool graded : {false, true}) {
      const long steps = std::lround(static_cast<double>(what.positive_steps(m)) / factor);
      all.add({m.name, fmt::format("dt = {:g} r dt_FE{}", factor, graded ? ", graded start" : ""),
               ssp ? league::ssp : league::any_sign,
               [&what, &m, steps, graded] { return what.run(m, steps, graded, time_limit.ours); }});
    }
  if (!m.embedded) return;
  for (const double tolerance : tolerances)
    all.add({m.name + ", adaptive", fmt::format("tolerance {:g}", tolerance), league::adaptive,
             [&what, &m, tolerance] { return what.run_to_tolerance(m, tolerance, time_limit.ours); }});
}

/// All pairs of tolerances.
struct ladder {
  std::vector<double> rtol, atol_by_rtol;
};

void add_sundials(contest& all, mixed_regime& what, const std::string& name, sundials_options options,
                  const std::vector<double>& nonlinear, const ladder& tolerances) {
  options.seconds_allowed = time_limit.others;
  for (const double coefficient : nonlinear)
    for (const double share : tolerances.atol_by_rtol)
      for (const double rtol : tolerances.rtol) {
        options.nonlinear = coefficient;
        options.rtol = rtol;
        options.atol = share * rtol;
        std::string more = coefficient > 0.0 ? fmt::format(", nonlinear coefficient {:g}", coefficient) : "";
        if (options.longest > 0.0) more += fmt::format(", dt ≤ {:g}", options.longest);
        all.add({name, fmt::format("rtol {:g}, atol {:g}{}", options.rtol, options.atol, more), league::other,
                 [&what, options] { return run_sundials(what, options); }});
      }
}

sundials_options make_options(integrator which, int order, linear_solver linear, bool tuned,
                              bool constrained = false) {
  sundials_options options;
  options.which = which;
  options.order = order;
  options.linear = linear;
  options.tuned = tuned;
  options.constrained = constrained;
  return options;
}

void add_arkode(contest& all, mixed_regime& what, const ladder& fine, const ladder& few) {
  for (const int order : {3, 4}) {
    add_sundials(all, what, fmt::format("ARKODE {}, defaults", order),
                 make_options(integrator::arkode, order, linear_solver::spgmr, false), {0.0},
                 {{1e-3}, {1e-3}});
    add_sundials(all, what, fmt::format("ARKODE {}, tuned, GMRES", order),
                 make_options(integrator::arkode, order, linear_solver::preconditioned, true), {0.1}, few);
    add_sundials(all, what, fmt::format("ARKODE {}, tuned", order),
                 make_options(integrator::arkode, order, linear_solver::projection_only, true), {0.1, 0.01},
                 fine);
    // Step limit of T as the explicit part; error control alone finds it only through failed steps.
    auto limited = make_options(integrator::arkode, order, linear_solver::projection_only, true);
    limited.longest = 0.008;
    add_sundials(all, what, fmt::format("ARKODE {}, tuned", order), limited, {0.1}, {fine.rtol, {1e-4}});
    add_sundials(all, what, fmt::format("ARKODE {}, tuned, f ≥ 0", order),
                 make_options(integrator::arkode, order, linear_solver::projection_only, true, true), {0.1},
                 {few.rtol, {1e-4}});
  }
  add_sundials(all, what, "ARKODE 5, tuned",
               make_options(integrator::arkode, 5, linear_solver::projection_only, true), {0.01}, fine);
}

void add_cvode(contest& all, mixed_regime& what, const ladder& fine) {
  add_sundials(all, what, "CVODE, defaults", make_options(integrator::cvode, 5, linear_solver::spgmr, false),
               {0.0}, {{1e-3}, {1e-3}});
  for (const bool constrained : {false, true}) {
    const char* more = constrained ? ", f ≥ 0" : "";
    add_sundials(all, what, fmt::format("CVODE, tuned, GMRES{}", more),
                 make_options(integrator::cvode, 5, linear_solver::preconditioned, false, constrained),
                 {0.1, 0.01}, fine);
    add_sundials(all, what, fmt::format("CVODE, tuned{}", more),
                 make_options(integrator::cvode, 5, linear_solver::projection_only, true, constrained), {0.1},
                 fine);
  }
}

/// Returns the number of explicit Runge–Kutta steps at the largest stable dt: 2.51 times the smallest ε on
/// the negative real axis.
long explicit_steps(double end, double smallest_epsilon) {
  return static_cast<long>(std::ceil(end / (2.5 * smallest_epsilon)));
}

/// Computes f by an explicit method with small steps; returns its distance from the solution of an entirely
/// different method. Implicit methods of any step below ε solve the same system on point values only: on
/// averages the collision acts at Gauss points that are reconstructed anew in every stage.
double find_reference(mixed_regime& what, unknowns which, bool quick) {
  field exact, second;
  const long steps = explicit_steps(what.end(), 0.8e-5);
  what.run(find_method("ssprk-5-4"), 2 * steps, true, 1e3, &exact);
  if (which == unknowns::points) {
    what.run(find_method("ark-548-2"), steps, true, 1e3, &second);
  } else {
    auto tight = make_options(integrator::arkode, 4, linear_solver::projection_only, true);
    tight.nonlinear = 0.01;
    tight.rtol = quick ? 1e-5 : 1e-6;
    tight.atol = 1e-4 * tight.rtol;
    tight.seconds_allowed = 1e3;
    run_sundials(what, tight, &second);
  }
  const double apart = mixed_regime::distance(second, exact);
  if (!(apart < (which == unknowns::points && !quick ? 1e-7 : 2e-6)))
    throw std::runtime_error(fmt::format("the reference solutions differ by {:.2g}", apart));
  what.set_reference(exact);
  return apart;
}

const char* const note =
    "CPU seconds of one thread for a given relative temporal error of f of the mixed-regime problem (40 "
    "cells, "
    "150 velocities, {}) at t = {:g} (2-norm over all cells and velocities), in brackets relative to the "
    "best of "
    "Apsis with f ≥ 0 throughout, and the minimum of f after any step. Contestants: every IMEX method of the "
    "catalogue and extrapolated Euler steps, with equal steps and with steps chosen by a tolerance; runs of "
    "methods with an SSP coefficient count only with f ≥ 0 throughout. For each contestant the cheapest run "
    "that "
    "reaches the error, whatever its setting. All use the same T and Q. ARKODE: T explicit, Q/ε implicit; "
    "tuned: "
    "implicit right-hand side deduced, 20 nonlinear iterations, and the inverse of the linearized collision "
    "as "
    "preconditioner of GMRES or instead of it. CVODE: BDF, tuned in the same way. f ≥ 0: with their "
    "constraint. "
    "—: no run reached the error in {:g} s. The reference, by an explicit method, is accurate to {:.1e} by "
    "comparison with an implicit one.";

std::vector<double> by_octaves(double from, double to) {
  std::vector<double> all;
  for (double x = from; x > 0.99 * to; x /= 2.0) {
    all.push_back(x);
    if (0.75 * x > 0.99 * to) all.push_back(0.75 * x);
  }
  return all;
}

}  // namespace

result_table race_on_mixed_regime(unknowns which, const std::vector<double>& errors,
                                  const settings& options) {
  const double end = options.quick ? 0.004 : 0.5;
  if (options.quick) time_limit = {0.3, 0.3};
  mixed_regime what(end, which);
  const double apart = find_reference(what, which, options.quick);
  contest all(errors, "s", true);
  const auto factors = options.quick ? std::vector<double>{4} : by_octaves(32.0, 0.25);
  const std::vector<double> tolerances =
      options.quick ? std::vector<double>{1e-3} : std::vector<double>{1e-3, 1e-4, 1e-5, 1e-6};
  for (const auto& name : imex_contestants()) add_ours(all, what, find_method(name), factors, tolerances);
  const ladder few = options.quick ? ladder{{1e-3}, {1e-3}} : ladder{{1e-2, 1e-3, 1e-4}, {1e-3, 1e-4}};
  const ladder fine =
      options.quick ? few : ladder{{1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6}, {1e-3, 1e-4}};
  add_arkode(all, what, fine, few);
  add_cvode(all, what, fine);
  all.add({"SSP-RK3", "largest stable dt", league::other, [&what, end] {
             return what.run(find_method("ssprk-3-3"), explicit_steps(end, 1e-5), false, 1e3);
           }});
  all.run(options.quick ? 0 : options.repeats, 3.0);
  result_table result;
  result.note =
      fmt::format(fmt::runtime(note), which == unknowns::averages ? "cell averages" : "point values", end,
                  time_limit.others, apart);
  result.columns = all.columns();
  for (const auto& rows : {all.best_of_ours(), all.rows(false), all.best_of_others()})
    result.rows.insert(result.rows.end(), rows.begin(), rows.end());
  result.data = {{"points", all.points()}, {"reference_error", apart}, {"end", end}};
  return result;
}

}  // namespace apsis::bench::peers
