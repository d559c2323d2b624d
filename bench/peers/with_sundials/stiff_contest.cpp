#include "peers/integrators.hpp"
#include "peers/radau_ode.hpp"
#include "stiff_contest.hpp"
#include "sundials_ode.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::peers {
namespace {

using integrator = sundials_ode_options::integrator;

/// Adds runs with 1 to `most_steps` equal steps, without and with graded starts of several growths.
void add_equal_steps(contest& all, const stiff_task& task, const std::string& name, league of,
                     long most_steps) {
  const auto add = [&](long steps) {
    for (const int growth : {0, 2, 4, 8})
      all.add({name,
               fmt::format("{} steps{}", steps, growth ? fmt::format(", graded start × {}", growth) : ""), of,
               [&task, name, steps, growth] { return task.run(name, steps, growth); }});
  };
  add(1);
  for (long steps = 2; steps <= most_steps; steps *= 2) {
    add(steps);
    add(steps + steps / 2);
  }
}

void add_ours(contest& all, const stiff_task& task, long most_steps, double tightest) {
  for (const auto& name : imex_contestants()) {
    const method& m = find_method(name);
    add_equal_steps(all, task, name, league_of(name), most_steps);
    if (!m.embedded) continue;
    for (const double tolerance : two_per_decade(1e-2, tightest))
      all.add({name + ", adaptive", fmt::format("tolerance {:.2g}", tolerance), league::adaptive,
               [&task, &m, tolerance] { return task.run_to_tolerance(m, tolerance); }});
  }
}

void add_explicit(contest& all, const stiff_task& task, long most_steps) {
  for (const auto& name : explicit_contestants())
    add_equal_steps(all, task, name, league_of(name), most_steps);
}

void add_other_integrators(contest& all, const stiff_task& task, long most_steps) {
  for (const auto& name : other_integrators()) add_equal_steps(all, task, name, league_of(name), most_steps);
}

void add_sundials(contest& all, const stiff_task& task, const std::string& name, sundials_ode_options options,
                  const std::vector<double>& nonlinear, double tightest) {
  for (const double coefficient : nonlinear)
    for (const double share : {1.0, 1e-2})
      for (const double rtol : two_per_decade(1e-2, tightest)) {
        options.nonlinear = coefficient;
        options.rtol = rtol;
        options.atol = share * rtol;
        all.add({name,
                 fmt::format("rtol {:.2g}, atol {:.2g}, nonlinear coefficient {:g}", options.rtol,
                             options.atol, coefficient),
                 league::other, [&task, options] { return run_sundials_ode(task, options); }});
      }
}

void add_radau(contest& all, const stiff_task& task, double tightest) {
  for (const double share : {1.0, 1e-2})
    for (const double rtol : two_per_decade(1e-2, tightest)) {
      const radau_options options{rtol, share * rtol};
      all.add({"Radau 5", fmt::format("rtol {:.2g}, atol {:.2g}", options.rtol, options.atol), league::other,
               [&task, options] { return run_radau(task, options); }});
    }
}

contest contestants(const stiff_task& task, bool quick) {
  contest all({1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}, "µs", false);
  const double tightest = quick ? 1e-4 : 1e-12;
  add_ours(all, task, quick ? 16 : 8192, quick ? 1e-3 : 1e-10);
  add_explicit(all, task, quick ? 16 : 8192);
  add_other_integrators(all, task, quick ? 16 : 8192);
  add_sundials(all, task, "CVODE, defaults", {integrator::cvode, 5, false}, {0.0}, tightest);
  add_sundials(all, task, "CVODE, tuned", {integrator::cvode, 5, true}, {0.1, 0.01}, tightest);
  add_sundials(all, task, "CVODE, tuned, u ≥ 0", {integrator::cvode, 5, true, true}, {0.1}, tightest);
  add_sundials(all, task, "ARKODE 4, defaults", {integrator::arkode_imex, 4, false}, {0.0}, tightest);
  for (const int order : {3, 4, 5})
    add_sundials(all, task, fmt::format("ARKODE {}, tuned", order), {integrator::arkode_imex, order, true},
                 {0.1, 0.001}, tightest);
  add_sundials(all, task, "ARKODE 5, all implicit, tuned", {integrator::arkode_dirk, 5, true}, {0.1, 0.001},
               tightest);
  for (const int order : {4, 5, 8})
    add_sundials(all, task, fmt::format("ARKODE {}, explicit", order), {integrator::arkode_explicit, order},
                 {0.0}, tightest);
  add_radau(all, task, tightest);
  return all;
}

const std::string note =
    std::string(
        " Contestants are every IMEX method of the catalogue, and extrapolated Euler steps of orders 2 to "
        "8. They take 1 to 8192 equal steps, without and with graded starts. The times of graded starts "
        "grow by factors of 2, 4 and 8. Contestants with an embedded solution also take steps chosen by a "
        "tolerance. Other contestants take equal steps. They are explicit methods, ") +
    words_of_others +
    ". Other programs are CVODE, ARKODE and Radau IIA of order 5. CVODE uses BDF and a dense solver. "
    "ARKODE integrates T explicitly, or all terms implicitly, or all terms explicitly. Radau IIA has "
    "the control of RADAU5 (bench/peers/radau_steps.hpp). The table shows CPU microseconds of a whole "
    "integration from t = 0 to 1 for a given error. The error is |Δu1| + |Δu2| at t = 1. Brackets "
    "contain the ratio to the best of Apsis. Each contestant is represented by the cheapest run that "
    "reaches the error, whatever its setting (steps, start-up, tolerances, nonlinear tolerance). Tuned "
    "programs have the exact Jacobian and deduce the implicit right-hand side. Integrators are created "
    "once and reinitialized.";

}  // namespace

result_table run(const stiff_race& race, const settings& options) {
  result_table result;
  result.title = race.title;
  result.note = race.problem + note;
  for (const double epsilon :
       options.quick ? std::vector<double>{1e-6} : std::vector<double>{1.0, 1e-2, 1e-4, 1e-6, 1e-10}) {
    const auto task = race.make(epsilon);
    contest all = contestants(*task, options.quick);
    all.run(options.quick ? 0 : options.repeats, 1.0);
    all.add_to(result, epsilon, true);
  }
  return result;
}

}  // namespace apsis::bench::peers
