// Models other than the gas in two and three dimensions: Broadwell's gas in the plane, gases of discrete
// velocities and conservation laws of the user. They agree with each other and with exact solutions.
#include "laws.hpp"

#include <apsis/run/setup.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace models_in_the_plane_test {

namespace {

const std::string on_the_plane = R"case([space]
cells = [24, 6]
domain = [[0.0, 2.0], [0.0, 1.0]]
limiter = "positivity"
[time]
method = "md-imex-6-3"
end = 0.1
dt = 0.004
)case";

const std::string plane = R"case([model]
name = "broadwell-plane"
epsilon = 0.02
[initial]
f_right = "1 + 0.3*sin(pi*x)"
f_left = "0.8 - 0.2*cos(pi*x)"
f_up = "0.6 + 0.2*sin(pi*x)"
f_down = "0.6 + 0.2*sin(pi*x)"
)case" + on_the_plane;

const char* const line = R"case([model]
name = "broadwell"
epsilon = 0.02
[initial]
f_plus = "1 + 0.3*sin(pi*x)"
f_minus = "0.8 - 0.2*cos(pi*x)"
f_0 = "0.6 + 0.2*sin(pi*x)"
[space]
cells = 24
domain = [0.0, 2.0]
formulation = "finite-difference"
limiter = "positivity"
[time]
method = "md-imex-6-3"
end = 0.1
dt = 0.004
)case";

/// Broadwell's gas as a table of velocities.
const std::string table = R"case([model]
name = "discrete-velocity"
velocities = [[1, 0], [-1, 0], [0, 1], [0, -1]]
collisions = [[1, 2, 3, 4]]
epsilon = 0.02
[initial]
f_1 = "1 + 0.3*sin(pi*x)"
f_2 = "0.8 - 0.2*cos(pi*x)"
f_3 = "0.6 + 0.2*sin(pi*x)"
f_4 = "0.6 + 0.2*sin(pi*x)"
)case" + on_the_plane;

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

/// Returns the mean of |a − b| of the first field.
double mean_difference(const apsis::simulation& a, const apsis::simulation& b) {
  const auto first = a.fields().values[0];
  const auto second = b.fields().values[0];
  double sum = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i) sum += std::abs(first[i] - second[i]);
  return sum / static_cast<double>(first.size());
}

/// u_t + (c·u)_x + … = 0 transports u with c.
const char* const advection = R"case([model]
name = "conservation-law"
variables = ["u"]
flux = ["u"]
flux_y = ["-0.5*u"]
speed = 2
epsilon = 0
[initial]
u = "1 + 0.3*sin(pi*x + 2*pi*y)"
[space]
cells = [16, 16]
domain = [[0.0, 2.0], [0.0, 1.0]]
[time]
method = "md-imex-6-3"
end = 0.2
dt = 0.002
)case";

/// The Euler equations with γ = 7/5. The gas carries a wave of the density with (1, 0.5).
const char* const density_wave = R"case([model]
name = "conservation-law"
variables = ["rho", "mx", "my", "E"]
flux = ["mx", "mx^2/rho + 0.4*(E - (mx^2 + my^2)/(2*rho))", "mx*my/rho",
        "mx/rho*(E + 0.4*(E - (mx^2 + my^2)/(2*rho)))"]
flux_y = ["my", "mx*my/rho", "my^2/rho + 0.4*(E - (mx^2 + my^2)/(2*rho))",
          "my/rho*(E + 0.4*(E - (mx^2 + my^2)/(2*rho)))"]
speed = 5
epsilon = 0
[initial]
rho = "1 + 0.2*sin(pi*(x + y))"
mx = "1 + 0.2*sin(pi*(x + y))"
my = "0.5*(1 + 0.2*sin(pi*(x + y)))"
E = "2.5 + 0.625*(1 + 0.2*sin(pi*(x + y)))"
[space]
cells = [16, 16]
domain = [[0.0, 2.0], [0.0, 2.0]]
[time]
method = "md-imex-6-3"
end = 0.1
dt = 0.001
)case";

/// Returns the largest error of the first variable. The exact solution is u₀(x − ct) at the centres of an n ×
/// m mesh.
double error_of_wave(const char* text, int n, double dt, const std::array<double, 2>& length,
                     const std::function<double(double, double)>& exact) {
  const auto run =
      finished_run(text, {fmt::format("space.cells=[{0}, {0}]", n), fmt::format("time.dt={}", dt)});
  const auto fields = run.fields();
  double largest = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = (i + 0.5) * length[0] / n, y = (j + 0.5) * length[1] / n;
      largest =
          std::max(largest, std::abs(fields.values[0][static_cast<std::size_t>(i * n + j)] - exact(x, y)));
    }
  return largest;
}

/// A hump of shallow water with g = 1 in a square basin.
const char* const basin = R"case([model]
name = "conservation-law"
variables = ["h", "p", "q"]
flux = ["p", "p^2/h + h^2/2", "p*q/h"]
flux_y = ["q", "p*q/h", "q^2/h + h^2/2"]
odd = ["p"]
odd_y = ["q"]
speed = 5
epsilon = 1e-3
[initial]
h = "1 + 0.5*exp(-10*(x^2 + y^2))"
p = 0
q = 0
[space]
cells = [20, 20]
domain = [[-1.0, 1.0], [-1.0, 1.0]]
boundary = "symmetry"
[time]
method = "md-imex-3-2"
end = 0.3
dt = 0.01
)case";

}  // namespace

TEST(models_in_the_plane, broadwell_along_x_is_the_model_on_a_line) {
  const auto flat = finished_run(plane, {}), thin = finished_run(line, {});
  const auto all = flat.fields(), expected = thin.fields();
  // The sums over 25 steps have another order.
  for (std::size_t i = 0; i < 24; ++i)
    for (std::size_t j = 0; j < 6; ++j) {
      EXPECT_NEAR(all.values[0][i * 6 + j], expected.values[0][i], 2e-14);
      EXPECT_NEAR(all.values[1][i * 6 + j], expected.values[1][i], 2e-14);
      EXPECT_NEAR(all.values[2][i * 6 + j], 0.0, 2e-14);
    }
}

TEST(models_in_the_plane, four_velocities_by_a_table_are_broadwells_gas) {
  for (const char* epsilon :
       {"model.epsilon=1", "model.epsilon=0.02", "model.epsilon=1e-9", "model.epsilon=0"}) {
    const auto closed = finished_run(plane, {epsilon}), general = finished_run(table, {epsilon});
    // There are 150 stages, each with some roundings of its Newton iterations.
    EXPECT_LT(largest_difference(closed.state(), general.state()), 1e-12) << epsilon;
  }
}

TEST(models_in_the_plane, stages_of_nine_velocities_have_the_order_of_their_method_at_every_epsilon) {
  const std::string text = R"case([model]
name = "discrete-velocity"
[initial]
f_1 = "1 + 0.3*sin(pi*x)*cos(pi*y)"
f_2 = 0.8
f_3 = "0.6 + 0.2*cos(pi*y)"
f_4 = "0.7 + 0.2*cos(pi*x)"
f_5 = 1.1
f_6 = 0.3
f_7 = "0.5 + 0.1*sin(pi*y)"
f_8 = 0.4
f_9 = 0.9
[space]
cells = [8, 8]
domain = [[0.0, 2.0], [0.0, 2.0]]
reconstruction = "upwind5"
[time]
end = 0.2
dt = 0.02
method = "md-imex-3-2"
)case";
  for (const auto& [method, order, parts] : {std::tuple{"md-imex-3-2", 2.0, 20}, {"md-imex-6-3", 3.0, 10}})
    for (const char* epsilon : {"1", "0"}) {
      std::vector<std::vector<double>> states;
      for (const int factor : {1, 2, 4})
        states.push_back(finished_run(text, {fmt::format("time.method={}", method),
                                             fmt::format("model.epsilon={}", epsilon),
                                             fmt::format("time.dt={}", 0.2 / (parts * factor))})
                             .state());
      const double coarse = largest_difference(states[0], states[1]),
                   fine = largest_difference(states[1], states[2]);
      // At these steps the next term of the error is 10 to 20 % of the first.
      EXPECT_GT(std::log2(coarse / fine), order - 0.3) << method << " " << epsilon;
      EXPECT_LT(std::log2(coarse / fine), order + 0.5) << method << " " << epsilon;
    }
}

TEST(models_in_the_plane, broadwells_gas_tends_to_the_law_of_its_limit) {
  // The limit is ρ_t + ∇·m = 0, m_x,t + ((ρ + (m_x² − m_y²)/ρ)/2)_x = 0, and the same for m_y along y. No
  // particle carries m_x along y. The two relaxations have other speeds, so only the limit is common.
  const std::string kinetic = R"case([model]
name = "broadwell-plane"
epsilon = 0
[initial]
rho = "1 + 0.2*sin(pi*(x + y))"
m = ["0.1*cos(pi*x)", "0.2*sin(pi*y)"]
[space]
domain = [[0.0, 2.0], [0.0, 2.0]]
cells = [8, 8]
[time]
method = "md-imex-6-3"
end = 0.2
cfl = 0.3
)case";
  const std::string limit = R"case([model]
name = "conservation-law"
variables = ["rho", "mx", "my"]
flux = ["mx", "(rho + (mx^2 - my^2)/rho)/2", "0"]
flux_y = ["my", "0", "(rho - (mx^2 - my^2)/rho)/2"]
speed = 3
epsilon = 0
[initial]
rho = "1 + 0.2*sin(pi*(x + y))"
mx = "0.1*cos(pi*x)"
my = "0.2*sin(pi*y)"
[space]
domain = [[0.0, 2.0], [0.0, 2.0]]
cells = [8, 8]
[time]
method = "md-imex-6-3"
end = 0.2
cfl = 0.3
)case";
  const auto difference = [&](int n) {
    const overrides mesh = {fmt::format("space.cells=[{0}, {0}]", n)};
    return mean_difference(finished_run(kinetic, mesh), finished_run(limit, mesh));
  };
  const double coarse = difference(16), fine = difference(32);
  EXPECT_LT(fine, 1e-4);
  EXPECT_GT(std::log2(coarse / fine), 3.0);  // of the method in time, and five in space
}

TEST(models_in_the_plane, laws_transport_waves_with_fifth_order) {
  using std::numbers::pi;
  const auto advected = [](double x, double y) {
    return 1.0 + 0.3 * std::sin(pi * (x - 0.2) + 2.0 * pi * (y + 0.5 * 0.2));
  };
  const double coarse = error_of_wave(advection, 16, 0.002, {2.0, 1.0}, advected),
               fine = error_of_wave(advection, 32, 0.001, {2.0, 1.0}, advected);
  EXPECT_LT(fine, 4e-6);
  EXPECT_GT(std::log2(coarse / fine), 4.5);
  const auto carried = [](double x, double y) { return 1.0 + 0.2 * std::sin(pi * (x + y - 1.5 * 0.1)); };
  const double coarse_gas = error_of_wave(density_wave, 16, 0.002, {2.0, 2.0}, carried),
               fine_gas = error_of_wave(density_wave, 32, 0.001, {2.0, 2.0}, carried);
  EXPECT_GT(std::log2(coarse_gas / fine_gas), 4.5);
}

TEST(models_in_the_plane, a_quarter_between_mirrors_is_the_whole) {
  const auto whole = finished_run(basin, {}),
             quarter = finished_run(basin, {"space.cells=[10, 10]", "space.domain=[[0, 1], [0, 1]]"});
  const auto all = whole.fields(), part = quarter.fields();
  for (std::size_t field = 0; field < 3; ++field)
    for (std::size_t i = 0; i < 10; ++i)
      for (std::size_t j = 0; j < 10; ++j)
        EXPECT_NEAR(all.values[field][(10 + i) * 20 + 10 + j], part.values[field][i * 10 + j], 1e-13);
  // The exchange of x and y exchanges the momenta.
  for (std::size_t i = 0; i < 20; ++i)
    for (std::size_t j = 0; j < 20; ++j) {
      EXPECT_NEAR(all.values[0][i * 20 + j], all.values[0][j * 20 + i], 1e-13);
      EXPECT_NEAR(all.values[1][i * 20 + j], all.values[2][j * 20 + i], 1e-13);
    }
}

TEST(models_in_the_plane, steps_are_as_long_as_every_single_velocity_allows) {
  // Particles of Broadwell's gas cross cells along one direction only.
  const apsis::run_setup four(apsis::parse_case(plane, "plane", {"space.cells=[20, 10]"}));
  EXPECT_DOUBLE_EQ(four.cfl_length(), 0.1);
  EXPECT_NEAR(four.make_problem()->forward_euler_step(0.0, four.initial_state()), 0.1, 1e-14);
  // Particles of velocity (1, 1) cross cells along both directions.
  const apsis::run_setup nine(
      apsis::parse_case("[model]\nname = \"discrete-velocity\"\n[space]\ncells = [20, 10]\ndomain = [[0, 2], "
                        "[0, 1]]\n[time]\nend = "
                        "1\ncfl = 0.5\nmethod = \"md-imex-3-2\"\n",
                        "nine", {}));
  EXPECT_DOUBLE_EQ(nine.cfl_length(), 0.05);
}

TEST(models_in_the_plane, laws_have_no_mirror_without_the_signs_of_its_direction) {
  bad_input::expect_refused({
      {[] { apsis::simulation(apsis::parse_case(basin, "law.toml", {"model.odd_y=[]"})); },
       {"model.odd_y does not say which"}},
  });
}

}  // namespace models_in_the_plane_test
