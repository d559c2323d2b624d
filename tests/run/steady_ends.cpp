// Steady states between ends of every kind are those of a time integrator.
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/case.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/method/method.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace steady_ends_test {
namespace {

/// A kind of end on the left with its keys, and an end on the right for which the flow is steady.
struct ends {
  std::string kind, keys, right;
};
void PrintTo(const ends& of, std::ostream* out) {
  *out << of.kind;
}

const std::string warm_wall = "kind = \"diffuse\"\nT = 1.2\n";
const std::string reservoir = "kind = \"pressure\"\np = 0.9\n";

std::vector<ends> all_ends() {
  return {{"diffuse", "T = 0.8\naccommodation = 0.6\n", warm_wall},
          {"adiabatic", "accommodation = 0.9\n", warm_wall},
          {"radiating", "sigma = 0.4\nsurroundings = 0.7\nemissivity = 0.8\n", warm_wall},
          {"symmetry", "", warm_wall},
          {"periodic", "", "kind = \"periodic\"\n"},
          {"given", "", reservoir},
          {"inflow", "rho = 1.1\nu = 0.2\nT = 1.1\n", reservoir},
          {"far-field", "rho = 1.1\nu = 0.2\nT = 1.1\n", reservoir},
          {"pressure", "p = 1.2\nT = 1.1\n", "kind = \"mass-flow\"\nflux = -0.1\n"},
          {"mass-flow", "flux = 0.1\nT = 1.1\n", reservoir},
          {"outflow", "", "kind = \"inflow\"\nrho = 1.1\nu = -1.5\nT = 1.1\n"},
          {"vacuum", "", "kind = \"inflow\"\nrho = 1.1\nu = -0.3\nT = 1.1\n"}};
}

/// Returns the keys of a kind. Those of a given row are g and h if the model has internal energy.
std::string keys_of(const ends& of, const std::string& model) {
  if (of.kind != "given") return of.keys;
  const std::string row = "*exp(-(v_x - 0.1)^2/1.8)\"\n";
  return model == "bgk" ? "f = \"0.4" + row : "g = \"0.4" + row + "h = \"0.7" + row;
}

apsis::simulation found(const ends& of, const std::string& model) {
  const std::string text = "[model]\nname = \"" + model +
                           "\"\nepsilon = 0.2\n[initial]\nrho = \"1 + 0.1*sin(2*pi*x)\"\nu = 0\nT = \"1 + "
                           "0.1*x*(1 - x)\"\n[space]\ncells = 12\nformulation = "
                           "\"finite-difference\"\n[boundary.left]\nkind = \"" +
                           of.kind + "\"\n" + keys_of(of, model) + "[boundary.right]\n" + of.right +
                           "[velocity]\nmax = 7\npoints = 24\n[steady]\ntolerance = 1e-11\n";
  apsis::simulation run(apsis::parse_case(text, "ends.toml"));
  while (!run.finished()) run.advance();
  return run;
}

apsis::field state_of(const apsis::simulation& run) {
  apsis::field u(run.mesh().size(), run.setup().equation->components());
  for (int cell = 0; cell < u.cells(); ++cell) std::ranges::copy(run.row(cell), u.row(cell));
  return u;
}

double largest_difference(const apsis::field& a, const apsis::field& b) {
  double largest = 0.0;
  for (int cell = 0; cell < a.cells(); ++cell)
    for (int k = 0; k < a.components(); ++k)
      largest = std::max(largest, std::abs(a.row(cell)[k] - b.row(cell)[k]));
  return largest;
}

/// Takes steps of a method whose steady state is that of the equation. They are so short that forward Euler's
/// method is stable with this reconstruction.
apsis::field after_steps(const apsis::simulation& run, const apsis::field& start) {
  const auto problem = run.setup().make_problem();
  apsis::stepper steps(apsis::find_method("forward-backward-euler"), *problem);
  apsis::field f = start;
  const double dt = 0.005 * problem->forward_euler_step(0.0, f);
  for (int n = 0; n < 400; ++n) steps.step(0.0, dt, f);
  return f;
}

class steady_ends : public testing::TestWithParam<ends> {};

}  // namespace

TEST_P(steady_ends, have_the_state_of_the_time_integrator) {
  for (const std::string model : {"bgk", "shakhov"}) {
    SCOPED_TRACE(model);
    const apsis::simulation run = found(GetParam(), model);
    EXPECT_LE(run.step(), GetParam().kind == "outflow" ? 100 : 60);
    const apsis::field state = state_of(run);
    // The tolerance of the residual is 1e-11 of the exchange between the ends while a molecule crosses the
    // domain. The steps take less time than that. They change the initial state by 1e-3 and more.
    EXPECT_LT(largest_difference(after_steps(run, state), state), 1e-11);
    const apsis::field start = run.setup().initial_state();
    EXPECT_GT(largest_difference(after_steps(run, start), start), 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(kinds, steady_ends, testing::ValuesIn(all_ends()));

TEST(steady_ends, of_every_kind_are_tested) {
  std::vector<std::string> tested = {"axis"};  // tests of axisymmetric flow cover the axis
  for (const ends& one : all_ends()) tested.push_back(one.kind);
  std::vector<std::string> known;
  for (const apsis::boundary_entry* one : apsis::boundary_entries()) known.push_back(one->name);
  EXPECT_THAT(tested, testing::UnorderedElementsAreArray(known));
}

}  // namespace steady_ends_test
