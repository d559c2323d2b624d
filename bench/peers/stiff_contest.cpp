#include "radau.hpp"
#include "stiff_contest.hpp"
#include "sundials_ode.hpp"

#include <apsis/method/certificate.hpp>

#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::peers {
namespace {

using integrator = sundials_ode_options::integrator;

/// Equal steps, 1 to `most_steps` of them, with and without a graded start.
void add_equal_steps(contest& all, const stiff_task& task, const method& m, league of, long most_steps) {
  const auto add = [&](long steps) {
    for (const bool graded : {false, true})
      all.add({m.name, fmt::format("{} steps{}", steps, graded ? ", graded start" : ""), of,
               [&task, &m, steps, graded] { return task.run(m, steps, graded); }});
  };
  add(1);
  for (long steps = 2; steps <= most_steps; steps *= 2) {
    add(steps);
    add(steps + steps / 2);
  }
}

/// Tolerances from 1e-2 to `tightest`, two in each decade.
std::vector<double> tolerances(double tightest) {
  std::vector<double> all;
  for (double rtol = 1e-2; rtol > 0.99 * tightest; rtol *= 0.316227766) all.push_back(rtol);
  return all;
}

void add_ours(contest& all, const stiff_task& task, long most_steps, double tightest) {
  for (const auto& name : imex_contestants()) {
    const method& m = find_method(name);
    const bool ssp = find_certificate(name).ssp_coefficient > 0;
    add_equal_steps(all, task, m, ssp ? league::ssp : league::any_sign, most_steps);
    if (!m.embedded) continue;
    for (const double tolerance : tolerances(tightest))
      all.add({name + ", adaptive", fmt::format("tolerance {:.2g}", tolerance), league::adaptive,
               [&task, &m, tolerance] { return task.run_to_tolerance(m, tolerance); }});
  }
}

void add_explicit(contest& all, const stiff_task& task, long most_steps) {
  for (const auto& name : method_names())
    if (const method& m = find_method(name); m.kind == method_kind::explicit_only)
      add_equal_steps(all, task, m, league::other, most_steps);
}

void add_sundials(contest& all, const stiff_task& task, const std::string& name, sundials_ode_options options,
                  const std::vector<double>& nonlinear, double tightest) {
  for (const double coefficient : nonlinear)
    for (const double share : {1.0, 1e-2})
      for (const double rtol : tolerances(tightest)) {
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
    for (const double rtol : tolerances(tightest)) {
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
  add_sundials(all, task, "CVODE, defaults", {integrator::cvode, 5, false}, {0.0}, tightest);
  add_sundials(all, task, "CVODE, tuned", {integrator::cvode, 5, true}, {0.1, 0.01}, tightest);
  add_sundials(all, task, "CVODE, tuned, u ≥ 0", {integrator::cvode, 5, true, true}, {0.1}, tightest);
  add_sundials(all, task, "ARKODE 4, defaults", {integrator::arkode_imex, 4, false}, {0.0}, tightest);
  for (const int order : {3, 4, 5})
    add_sundials(all, task, fmt::format("ARKODE {}, tuned", order), {integrator::arkode_imex, order, true},
                 {0.1, 0.001}, tightest);
  add_sundials(all, task, "ARKODE 5, all implicit, tuned", {integrator::arkode_dirk, 5, true}, {0.1, 0.001},
               tightest);
  add_radau(all, task, tightest);
  return all;
}

const char* const note =
    " Contestants: every IMEX method of the catalogue, and extrapolated Euler steps of orders 2 to 8, with 1 "
    "to "
    "8192 equal steps, with and without a graded start, and with steps chosen by a tolerance where it has an "
    "embedded solution; explicit SSP methods; CVODE (BDF, dense); ARKODE (T explicit, or all implicit); "
    "Radau "
    "IIA of order 5 with the control of RADAU5 (bench/peers/radau.cpp). CPU microseconds of a whole "
    "integration "
    "from t = 0 to 1 for a given error |Δu1| + |Δu2| at t = 1; in brackets relative to the best of Apsis. "
    "For "
    "each contestant the cheapest run that reaches the error, whatever its setting (steps, start-up, "
    "tolerances, "
    "nonlinear tolerance). Tuned: exact Jacobian, implicit right-hand side deduced. Integrators are created "
    "once "
    "and reinitialized.";

}  // namespace

result_table run(const stiff_race& race, const settings& options) {
  result_table result;
  result.title = race.title;
  result.note = race.problem + note;
  auto& points = result.data["points"] = nlohmann::json::array();
  for (const double epsilon :
       options.quick ? std::vector<double>{1e-6} : std::vector<double>{1.0, 1e-2, 1e-4, 1e-6, 1e-10}) {
    const auto task = race.make(epsilon);
    contest all = contestants(*task, options.quick);
    all.run(options.quick ? 0 : options.repeats, 1.0);
    if (result.columns.empty()) {
      result.columns = all.columns();
      result.columns.insert(result.columns.begin(), "ε");
    }
    for (const auto& rows : {all.best_of_ours(), all.rows(true), all.best_of_others()})
      for (auto row : rows) {
        row.insert(row.begin(), fmt::format("{:g}", epsilon));
        result.rows.push_back(std::move(row));
      }
    for (auto point : all.points()) {
      point["epsilon"] = epsilon;
      points.push_back(std::move(point));
    }
  }
  return result;
}

}  // namespace apsis::bench::peers
