// Work–precision on the ODE model: Apsis, CVODE and ARKODE.
#include "measure/table.hpp"
#include "peers/ode.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::peers_ode_table {
namespace {

using namespace peers;
using integrator = sundials_ode_options::integrator;

void add_ours(contest& all, const ode_task& task, const std::string& name, long most_steps) {
  const method& m = find_method(name);
  const auto add = [&](long steps) {
    for (const bool graded : {false, true})
      all.add({name, fmt::format("{} steps{}", steps, graded ? ", graded start" : ""), true,
               [&task, &m, steps, graded] { return run_ode(task, m, steps, graded); }});
  };
  for (long steps = 2; steps <= most_steps; steps *= 2) {
    add(steps);
    add(steps + steps / 2);
  }
}

void add_sundials(contest& all, const ode_task& task, const std::string& name, sundials_ode_options options,
                  const std::vector<double>& nonlinear, double tightest) {
  for (const double coefficient : nonlinear)
    for (const double share : {1.0, 1e-2})
      for (double rtol = 1e-2; rtol > 0.99 * tightest; rtol *= options.constrained ? 0.1 : 0.316227766) {
        options.nonlinear = coefficient;
        options.rtol = rtol;
        options.atol = share * rtol;
        all.add({name,
                 fmt::format("rtol {:.2g}, atol {:.2g}, nonlinear coefficient {:g}", options.rtol,
                             options.atol, coefficient),
                 false, [&task, options] { return run_sundials_ode(task, options); }});
      }
}

contest race(const ode_task& task, bool quick) {
  contest all({1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}, contest::rule::any_sign);
  const long most_steps = quick ? 64 : 8192;
  for (const char* name :
       {"md-imex-3-2", "md-imex-6-3", "md-imex-5-2", "md-imex-6-2-mixed", "md-imex-8-3", "md-imex-8-3-mixed",
        "md-imex-8-3-accurate", "md-imex-14-4-accurate", "md-imex-16-4-accurate"})
    add_ours(all, task, name, most_steps);
  const double tightest = quick ? 1e-4 : 1e-12;
  add_sundials(all, task, "CVODE, defaults", {integrator::cvode, 5, false}, {0.0}, tightest);
  add_sundials(all, task, "CVODE, tuned", {integrator::cvode, 5, true}, {0.1, 0.01}, tightest);
  add_sundials(all, task, "CVODE, tuned, u ≥ 0", {integrator::cvode, 5, true, true}, {0.1}, tightest);
  add_sundials(all, task, "ARKODE 4, defaults", {integrator::arkode_imex, 4, false}, {0.0}, tightest);
  for (const int order : {3, 4, 5})
    add_sundials(all, task, fmt::format("ARKODE {}, tuned", order), {integrator::arkode_imex, order, true},
                 {0.1, 0.001}, tightest);
  add_sundials(all, task, "ARKODE 5, all implicit, tuned", {integrator::arkode_dirk, 5, true}, {0.1, 0.001},
               tightest);
  return all;
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "ODE model: work and precision";
  result.note =
      "CPU microseconds of a whole integration from t = 0 to 1 of the ODE model of the paper (data out of "
      "equilibrium) for a given error |Δu1| + |Δu2| at t = 1; in brackets relative to the best Apsis "
      "method. For each contestant the cheapest run that reaches the error, whatever its setting (steps, "
      "start-up, tolerances, nonlinear tolerance). CVODE: BDF, dense; ARKODE: (u2, 0) explicit. Tuned: "
      "exact Jacobian, implicit right-hand side deduced. Integrators are created once and reinitialized. "
      "The reference is extrapolated in extended precision to 1e-13.";
  auto& points = result.data["points"] = nlohmann::json::array();
  const auto values =
      options.quick ? std::vector<double>{1e-6} : std::vector<double>{1.0, 1e-2, 1e-4, 1e-6, 1e-10};
  for (const double epsilon : values) {
    const ode_task task{epsilon, ode_reference(epsilon)};
    contest all = race(task, options.quick);
    all.run(options.quick ? 0 : options.repeats, 1.0);
    if (result.columns.empty()) {
      result.columns = all.columns();
      result.columns.insert(result.columns.begin(), "ε");
    }
    const auto with_epsilon = [&](std::vector<nlohmann::json> row) {
      row.insert(row.begin(), fmt::format("{:g}", epsilon));
      result.rows.push_back(std::move(row));
    };
    for (auto& row : all.rows()) with_epsilon(std::move(row));
    for (auto& row : all.best_of_others()) with_epsilon(std::move(row));
    for (auto point : all.points()) {
      point["epsilon"] = epsilon;
      points.push_back(std::move(point));
    }
  }
  return result;
}

const registered here({"peers-ode", "work and precision against SUNDIALS, ODE model", measure});

}  // namespace
}  // namespace apsis::bench::peers_ode_table
