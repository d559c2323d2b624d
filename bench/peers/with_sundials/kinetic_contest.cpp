#include "kinetic_contest.hpp"
#include "peers/integrators.hpp"
#include "peers/radau_kinetic.hpp"
#include "sundials_kinetic.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::peers {
namespace {

/// Adds runs with equal steps, with and without a graded start.
void add_equal_steps(contest& all, kinetic_task& task, const std::string& name, league of,
                     const kinetic_settings& settings) {
  for (const double factor : settings.factors)
    for (const bool graded : {false, true}) {
      const long steps = std::max(1L, std::lround(static_cast<double>(task.positive_steps(name)) / factor));
      all.add({name, fmt::format("dt = {:g} r dt_FE{}", factor, graded ? ", graded start" : ""), of,
               [&task, name, steps, graded, seconds = settings.seconds_ours] {
                 return task.run(name, steps, graded, seconds);
               }});
    }
}

void add_ours(contest& all, kinetic_task& task, const std::string& name, const kinetic_settings& settings) {
  add_equal_steps(all, task, name, league_of(name), settings);
  const method& m = find_method(name);
  if (!m.embedded) return;
  for (const double tolerance : settings.tolerances)
    all.add({name + ", adaptive", fmt::format("tolerance {:g}", tolerance), league::adaptive,
             [&task, &m, tolerance, seconds = settings.seconds_ours] {
               return task.run_to_tolerance(m, tolerance, seconds);
             }});
}

void add_sundials(contest& all, kinetic_task& task, const std::string& name, sundials_options options,
                  const std::vector<double>& nonlinear, const ladder& tolerances) {
  for (const double coefficient : nonlinear)
    for (const double share : tolerances.atol_by_rtol)
      for (const double rtol : tolerances.rtol) {
        options.nonlinear = coefficient;
        options.rtol = rtol;
        options.atol = share * rtol;
        std::string more = coefficient > 0.0 ? fmt::format(", nonlinear coefficient {:g}", coefficient) : "";
        if (options.longest > 0.0) more += fmt::format(", dt ≤ {:g}", options.longest);
        all.add({name, fmt::format("rtol {:g}, atol {:g}{}", options.rtol, options.atol, more), league::other,
                 [&task, options] { return run_sundials(task, options); }});
      }
}

sundials_options make_options(const kinetic_settings& settings, sundials_options::integrator which, int order,
                              linear_solver linear, bool tuned, bool constrained = false) {
  sundials_options options;
  options.which = which;
  options.order = order;
  options.linear = linear;
  options.tuned = tuned;
  options.constrained = constrained;
  options.seconds_allowed = settings.seconds_others;
  return options;
}

void add_arkode(contest& all, kinetic_task& task, const kinetic_settings& settings) {
  const auto options = [&](int order, linear_solver linear, bool tuned) {
    return make_options(settings, sundials_options::integrator::arkode, order, linear, tuned);
  };
  for (const int order : {3, 4, 5}) {
    const auto tuned = fmt::format("ARKODE {}, tuned", order);
    auto limited = options(order, linear_solver::collision_only, true);
    add_sundials(all, task, tuned, limited, {0.1, 0.01}, settings.fine);
    limited.longest = settings.longest;
    add_sundials(all, task, tuned, limited, {0.1}, {settings.fine.rtol, {1e-4}});
    if (order == 5) continue;
    add_sundials(all, task, fmt::format("ARKODE {}, defaults", order),
                 options(order, linear_solver::spgmr, false), {0.0}, settings.defaults);
    add_sundials(all, task, tuned + ", GMRES", options(order, linear_solver::preconditioned, true), {0.1},
                 settings.few);
  }
}

void add_tuned_cvode(contest& all, kinetic_task& task, const kinetic_settings& settings, bool constrained,
                     const std::string& more) {
  const ladder& fine = settings.fine;
  const auto options = [&](linear_solver linear, bool tuned) {
    return make_options(settings, sundials_options::integrator::cvode, 5, linear, tuned, constrained);
  };
  add_sundials(all, task, "CVODE, tuned, GMRES" + more, options(linear_solver::preconditioned, false),
               {0.1, 0.01}, fine);
  add_sundials(all, task, "CVODE, tuned" + more, options(linear_solver::collision_only, true), {0.1}, fine);
}

void add_cvode(contest& all, kinetic_task& task, const kinetic_settings& settings) {
  add_sundials(all, task, "CVODE, defaults",
               make_options(settings, sundials_options::integrator::cvode, 5, linear_solver::spgmr, false),
               {0.0}, settings.defaults);
  add_tuned_cvode(all, task, settings, false, "");
}

void add_radau(contest& all, kinetic_task& task, const kinetic_settings& settings) {
  for (const double share : settings.implicit.atol_by_rtol)
    for (const double rtol : settings.implicit.rtol) {
      const radau_options options{rtol, share * rtol};
      all.add({"Radau 5", fmt::format("rtol {:.2g}, atol {:.2g}", options.rtol, options.atol), league::other,
               [&task, options, seconds = settings.seconds_others] {
                 return run_radau(task, options, seconds);
               }});
    }
}

void add_explicit(contest& all, kinetic_task& task, const kinetic_settings& settings,
                  const std::string& more) {
  for (const auto& name : settings.explicit_methods)
    for (const long steps : settings.explicit_steps)
      all.add({name + more, fmt::format("{} steps", steps), league_of(name),
               [&task, name, steps, seconds = settings.seconds_others] {
                 return task.run(name, steps, false, seconds);
               }});
}

}  // namespace

void enter_all(contest& all, kinetic_task& task, const kinetic_settings& settings) {
  for (const auto& name : imex_contestants()) add_ours(all, task, name, settings);
  for (const auto& name : other_integrators()) add_equal_steps(all, task, name, league_of(name), settings);
  add_arkode(all, task, settings);
  add_cvode(all, task, settings);
  add_radau(all, task, settings);
  enter_constrained_and_explicit(all, task, settings, "");
}

void enter_constrained_and_explicit(contest& all, kinetic_task& task, const kinetic_settings& settings,
                                    const std::string& more) {
  for (const int order : {3, 4})
    add_sundials(all, task, fmt::format("ARKODE {}, tuned, f ≥ 0{}", order, more),
                 make_options(settings, sundials_options::integrator::arkode, order,
                              linear_solver::collision_only, true, true),
                 {0.1}, {settings.fine.rtol, {1e-4}});
  add_tuned_cvode(all, task, settings, true, ", f ≥ 0" + more);
  add_explicit(all, task, settings, more);
}

std::vector<double> by_octaves(double from, double to) {
  std::vector<double> all;
  for (double octave = from; octave > 0.99 * to; octave /= 2.0) {
    const int lengths = octave > 1.0 ? 8 : 4;
    for (int k = 0; k < lengths; ++k)
      if (const double x = octave * (1.0 - 0.5 * k / lengths); x > 0.99 * to) all.push_back(x);
  }
  return all;
}

}  // namespace apsis::bench::peers
