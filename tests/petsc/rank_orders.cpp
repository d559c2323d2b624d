#include "planes.hpp"
#include "problems.hpp"

#include <map>
#include <string>
#include <vector>

/// Orders of methods on all processes, for all problems. Steps are few, because a busy machine takes
/// milliseconds for each sum over processes.
namespace petsc_rank_orders {

using namespace petsc_runs;

/// Solutions of an equation at its end of time, with options and a number of steps, and the reference there.
struct equation {
  std::vector<double> (*solve)(const std::string& more, int steps);
  std::vector<double> (*reference)();
};

/// Returns the solution of a problem at `end`, on the points of a DM.
template <class Problem>
std::vector<double> solve_on(DM dm, Problem problem, const std::string& text, double end, int steps) {
  const options now("-ts_adapt_type none -snes_stol 1e-12 -ksp_rtol 1e-10 " + text);
  run one(dm);
  problem.enter(one);
  return one.solve(end, end / steps).u;
}

/// Another integrator of PETSc computes references with errors below 1e-10.
constexpr const char* other = "-ts_type arkimex -ts_arkimex_type 5 -snes_rtol 1e-13";

std::vector<double> solve_exchange(const std::string& text, int steps) {
  return solve_on(line(12, 2, DM_BOUNDARY_PERIODIC), exchange{.epsilon = 0.5}, text, 0.25, steps);
}
std::vector<double> solve_diffusive_exchange(const std::string& text, int steps) {
  return solve_on(line(12, 2, DM_BOUNDARY_PERIODIC), diffusive_exchange{{.epsilon = 0.5}}, text, 0.25, steps);
}
std::vector<double> solve_brusselator(const std::string& text, int steps) {
  return solve_on(line(20, 2, DM_BOUNDARY_NONE), brusselator(), text, 0.5, steps);
}
std::vector<double> solve_gray_scott(const std::string& text, int steps) {
  return solve_on(plane(10, 2), gray_scott(), text, 8.0, steps);
}

constexpr double end_of_heat = 0.1;

std::vector<double> solve_heat(const std::string& text, int steps) {
  const options now("-ts_adapt_type none -snes_stol 1e-12 -ksp_rtol 1e-12 " + text);
  run one(line(19, 1, DM_BOUNDARY_NONE));
  heat problem;
  problem.enter(one);
  return one.solve(end_of_heat, end_of_heat / steps).u;
}
std::vector<double> exact_heat() {
  run one(line(19, 1, DM_BOUNDARY_NONE));
  heat problem;
  problem.enter(one);
  auto u = gathered(one.u());
  for (double& each : u) each *= std::exp(problem.lambda * end_of_heat);
  return u;
}

const std::map<std::string, equation>& equations() {
  static const std::map<std::string, equation> all = {
      {"advection_reaction", {solve_exchange, [] { return solve_exchange(other, 500); }}},
      {"advection_diffusion_reaction",
       {solve_diffusive_exchange, [] { return solve_diffusive_exchange(other, 500); }}},
      {"brusselator", {solve_brusselator, [] { return solve_brusselator(other, 500); }}},
      {"heat", {solve_heat, exact_heat}},
      {"gray_scott", {solve_gray_scott, [] { return solve_gray_scott(other, 200); }}}};
  return all;
}

/// Returns the reference of an equation, which every process computes alone and once.
const std::vector<double>& reference_of(const std::string& name) {
  static std::map<std::string, std::vector<double>> known;
  const auto found = known.find(name);
  if (found != known.end()) return found->second;
  return known.emplace(name, alone(equations().at(name).reference)).first->second;
}

struct expectation {
  const char* equation;
  const char* method;
  double order;
  int steps;  ///< the larger steps; the others have half their length
};

class orders : public testing::TestWithParam<expectation> {};

TEST_P(orders, are_those_of_the_method) {
  const auto [name, method, order, steps] = GetParam();
  const auto error = [&, text = std::string("-ts_apsis_method ") + method](int n) {
    return distance(equations().at(name).solve(text, n), reference_of(name));
  };
  const double coarse = error(steps), fine = error(2 * steps), found = std::log2(coarse / fine);
  // Because steps are finite, the observed order may be 0.4 too low. Some methods gain an order.
  EXPECT_GT(found, order - 0.4) << coarse << " " << fine;
  EXPECT_LT(found, order + 1.2) << coarse << " " << fine;
}

INSTANTIATE_TEST_SUITE_P(
    ranks, orders,
    testing::Values(expectation{"advection_reaction", "md-imex-4-2", 2, 8},
                    expectation{"advection_reaction", "md-imex-8-3-mixed", 3, 8},
                    expectation{"advection_reaction", "ark-436", 4, 8},
                    expectation{"advection_reaction", "imdrk-3-3", 3, 8},
                    expectation{"advection_diffusion_reaction", "md-imex-4-2", 2, 8},
                    expectation{"advection_diffusion_reaction", "md-imex-8-3-mixed", 3, 8},
                    expectation{"advection_diffusion_reaction", "ark-436", 4, 8},
                    expectation{"advection_diffusion_reaction", "imdrk-3-3", 3, 8},
                    expectation{"brusselator", "md-imex-4-2", 2, 8},
                    expectation{"brusselator", "md-imex-8-3-mixed", 3, 16},
                    expectation{"brusselator", "ark-436", 4, 8},
                    expectation{"brusselator", "imdrk-3-3", 3, 8}, expectation{"heat", "imdrk-3-3", 3, 4},
                    expectation{"gray_scott", "md-imex-4-2", 2, 8},
                    expectation{"gray_scott", "md-imex-8-3-mixed", 3, 16},
                    expectation{"gray_scott", "ark-436", 4, 8}, expectation{"gray_scott", "imdrk-3-3", 3, 8}),
    [](const auto& one) {
      std::string name = std::string(one.param.equation) + "_by_" + one.param.method;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

}  // namespace petsc_rank_orders
