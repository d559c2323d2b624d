// Work–precision on the mixed-regime problem: Apsis, SUNDIALS and an explicit method, with the same kernels.
#include "measure/table.hpp"
#include "peers/mixed.hpp"
#include "peers/sundials_mixed.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::peers_mixed_table {
namespace {

using namespace peers;
using integrator = sundials_options::integrator;

/// Time limit of a run in seconds; the fastest runs need a fiftieth of it.
double time_limit = 10.0;

void add_ours(contest& all, mixed_regime& what, const std::string& name, const std::vector<double>& factors) {
  const method& m = find_method(name);
  for (const double factor : factors)
    for (const bool graded : {false, true}) {
      const long steps = std::lround(static_cast<double>(what.positive_steps(m)) / factor);
      all.add({name, fmt::format("dt = {:g} r dt_FE{}", factor, graded ? ", graded start" : ""), true,
               [&what, &m, steps, graded] { return what.run(m, steps, graded, time_limit); }});
    }
}

/// All pairs of tolerances.
struct ladder {
  std::vector<double> rtol, atol_by_rtol;
};

void add_sundials(contest& all, mixed_regime& what, const std::string& name, sundials_options options,
                  const std::vector<double>& nonlinear, const ladder& tolerances) {
  options.seconds_allowed = time_limit;
  for (const double coefficient : nonlinear)
    for (const double share : tolerances.atol_by_rtol)
      for (const double rtol : tolerances.rtol) {
        options.nonlinear = coefficient;
        options.rtol = rtol;
        options.atol = share * rtol;
        std::string more = coefficient > 0.0 ? fmt::format(", nonlinear coefficient {:g}", coefficient) : "";
        if (options.longest > 0.0) more += fmt::format(", dt ≤ {:g}", options.longest);
        all.add({name, fmt::format("rtol {:g}, atol {:g}{}", options.rtol, options.atol, more), false,
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
/// different method with a tight tolerance.
double find_reference(mixed_regime& what, bool quick) {
  field exact, second;
  const auto& rk = find_method("ssprk-3-3");
  what.run(rk, explicit_steps(what.end(), 0.8e-5), false, 1e3, &exact);
  auto tight = make_options(integrator::arkode, 4, linear_solver::projection_only, true);
  tight.nonlinear = 0.01;
  tight.rtol = quick ? 1e-5 : 1e-6;
  tight.atol = 1e-4 * tight.rtol;
  tight.seconds_allowed = 1e3;
  run_sundials(what, tight, &second);
  const double apart = mixed_regime::distance(second, exact);
  if (!(apart < 2e-6))
    throw std::runtime_error(fmt::format("the reference solutions differ by {:.2g}", apart));
  what.set_reference(exact);
  return apart;
}

const char* const note =
    "CPU seconds of one thread for a given relative temporal error of f of paper/bgk-mixed (40 cells, 150 "
    "velocities) at t = {:g} (2-norm over all cells and velocities), in brackets relative to the best "
    "Apsis method, and the minimum of f after any step. For each contestant the cheapest run that reaches "
    "the error, whatever its setting; runs of Apsis count only with f ≥ 0 throughout. All use the same T "
    "and Q. ARKODE: T explicit, Q/ε implicit; tuned: implicit right-hand side deduced, 20 nonlinear "
    "iterations, and the inverse of the linearized collision as preconditioner of GMRES or instead of it. "
    "CVODE: BDF, tuned in the same way. f ≥ 0: with their constraint. —: no run reached the error in {:g} "
    "s. The reference (explicit, small steps) is accurate to {:.1e} by comparison with ARKODE.";

result_table measure(const settings& options) {
  const double end = options.quick ? 0.004 : 0.5;
  if (options.quick) time_limit = 0.3;
  mixed_regime what(end);
  const double apart = find_reference(what, options.quick);
  contest all({1e-3, 3e-4, 1e-4, 1e-5});
  const std::vector<double> factors =
      options.quick ? std::vector<double>{4} : std::vector<double>{16, 14, 12, 10, 8, 6, 4, 2, 1};
  for (const char* name :
       {"md-imex-3-2", "md-imex-6-3", "md-imex-5-2", "md-imex-6-2-mixed", "md-imex-8-3", "md-imex-8-3-mixed"})
    add_ours(all, what, name, factors);
  if (!options.quick) add_ours(all, what, "md-imex-8-3-mixed", {0.8, 0.65, 0.5});
  const ladder few = options.quick ? ladder{{1e-3}, {1e-3}} : ladder{{1e-2, 1e-3, 1e-4}, {1e-3, 1e-4}};
  const ladder fine = options.quick ? few : ladder{{1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5}, {1e-3, 1e-4}};
  add_arkode(all, what, fine, few);
  add_cvode(all, what, fine);
  all.add({"SSP-RK3", "largest stable dt", false, [&what, end] {
             return what.run(find_method("ssprk-3-3"), explicit_steps(end, 1e-5), false, 1e3);
           }});
  all.run(options.quick ? 0 : options.repeats, 3.0);
  result_table result;
  result.title = "Mixed-regime BGK: work and precision";
  result.note = fmt::format(fmt::runtime(note), end, time_limit, apart);
  result.columns = all.columns();
  result.rows = all.rows();
  for (auto& row : all.best_of_others()) result.rows.push_back(std::move(row));
  result.data = {{"points", all.points()}, {"reference_error", apart}, {"end", end}};
  return result;
}

const registered here({"peers-mixed", "work and precision against SUNDIALS and SSP-RK3, mixed regime",
                       measure});

}  // namespace
}  // namespace apsis::bench::peers_mixed_table
