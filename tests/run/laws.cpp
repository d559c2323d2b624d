// Runs of conservation laws of the user agree with solutions known independently of the relaxation.
#include "laws.hpp"

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace laws_test {

namespace {

/// Returns the root of a monotone function by bisection.
double root(double low, double high, const std::function<double(double)>& f) {
  const bool below = f(low) < 0.0;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (((f(middle) < 0.0) == below) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Returns the depth of the dam break at x/t = s with g = 1, from depths `left` > `right` at rest. A
/// rarefaction with u + 2c = 2c_l, a constant state, and a bore with (h − h_r)² (h + h_r)/(2 h h_r) = u²
/// (Stoker 1957).
double depth_of_dam_break(double s, double left, double right) {
  const double cl = std::sqrt(left);
  const auto velocity = [&](double h) { return (h - right) * std::sqrt(0.5 * (h + right) / (h * right)); };
  const double h = root(right, left, [&](double d) { return velocity(d) - 2.0 * (cl - std::sqrt(d)); });
  const double u = velocity(h), bore = h * u / (h - right);
  if (s > bore) return right;
  if (s > u - std::sqrt(h)) return h;
  if (s < -cl) return left;
  const double c = (2.0 * cl - s) / 3.0;
  return c * c;
}

/// Returns the density of Sod's tube at x/t = s with γ = 7/5: rarefaction, contact and shock (Toro 2009,
/// chapter 4).
double density_of_sod(double s) {
  constexpr double gamma = 1.4, rl = 1.0, pl = 1.0, rr = 0.125, pr = 0.1;
  const double cl = std::sqrt(gamma * pl / rl), cr = std::sqrt(gamma * pr / rr);
  const auto behind_shock = [&](double p) {
    return (p - pr) * std::sqrt(2.0 / ((gamma + 1.0) * rr) / (p + (gamma - 1.0) / (gamma + 1.0) * pr));
  };
  const auto behind_fan = [&](double p) {
    return 2.0 * cl / (gamma - 1.0) * (1.0 - std::pow(p / pl, (gamma - 1.0) / (2.0 * gamma)));
  };
  const double p = root(pr, pl, [&](double q) { return behind_shock(q) - behind_fan(q); });
  const double u = behind_fan(p), left = rl * std::pow(p / pl, 1.0 / gamma);
  const double ratio = (gamma - 1.0) / (gamma + 1.0), right = rr * (p / pr + ratio) / (ratio * p / pr + 1.0);
  const double shock = cr * std::sqrt((gamma + 1.0) / (2.0 * gamma) * p / pr + (gamma - 1.0) / (2.0 * gamma));
  if (s > shock) return rr;
  if (s > u) return right;
  if (s > u - std::sqrt(gamma * p / left)) return left;
  if (s < -cl) return rl;
  return rl * std::pow((2.0 + (gamma - 1.0) * (-s) / cl) / (gamma + 1.0), 2.0 / (gamma - 1.0));
}

/// Returns the mean of |u − exact(x/t)| over the cells, for the first variable.
double mean_error(const apsis::simulation& run, const std::function<double(double)>& exact) {
  const auto fields = run.fields();
  double sum = 0.0;
  for (std::size_t i = 0; i < fields.x.size(); ++i)
    sum += std::abs(fields.values[0][i] - exact(fields.x[i] / run.t()));
  return sum / static_cast<double>(fields.x.size());
}

// A simple wave of shallow water with g = 1 and c₀ = 1 that runs to the right: u = 2(c − c₀). c is constant
// along lines of the speed 3c − 2c₀.
double wave_of_c(double x) {
  return 1.0 + 0.1 * std::sin(std::numbers::pi * x);
}
const char* const simple_wave = R"case([model]
name = "conservation-law"
variables = ["h", "q"]
flux = ["q", "q^2/h + h^2/2"]
speed = 2
epsilon = 0
[initial]
h = "(1 + 0.1*sin(pi*x))^2"
q = "(1 + 0.1*sin(pi*x))^2 * 0.2*sin(pi*x)"
[space]
cells = 80
domain = [0.0, 2.0]
formulation = "finite-difference"
[time]
method = "md-imex-6-3"
end = 0.4
cfl = 0.5
)case";

/// Linear waves p_t + 4 w_x = 0, w_t + p_x = 0 of speed 2 from p = 1 + sin(πx) and w = 0.
const char* const linear_waves = R"case([model]
name = "conservation-law"
variables = ["p", "w"]
flux = ["4*w", "p"]
speed = 3
[initial]
p = "1 + sin(pi*x)"
w = 0
[space]
cells = 40
domain = [0.0, 2.0]
formulation = "finite-difference"
[time]
method = "md-imex-6-3"
end = 0.5
cfl = 0.5
)case";

/// Returns the largest error of p at the end. For a mode e^{iπx} the relaxation system is u' = −iπ v, v' =
/// −iπ a² u + (F u − v)/ε with fluxes v. It splits into the two characteristic variables p ± 2w with F = ±2.
/// Exponentials solve the two linear equations of each.
double error_of_linear_waves(const overrides& changes, double epsilon) {
  using complex = std::complex<double>;
  const auto run = finished_run(linear_waves, changes);
  const double t = run.t(), k = std::numbers::pi, a = 3.0;
  const auto mode = [&](double speed) {
    // The equation is u'' + u'/ε + (k²a² + i k F/ε) u = 0 with u = 1 and u' = −i k F at t = 0.
    const complex half = 0.5 / epsilon, frequency = k * k * a * a + complex(0.0, k * speed / epsilon);
    const complex spread = std::sqrt(half * half - frequency);
    const complex fast = -half - spread, slow = frequency / fast;  // their product is the frequency
    const complex start(0.0, -k * speed);
    return ((start - fast) * std::exp(slow * t) - (start - slow) * std::exp(fast * t)) / (slow - fast);
  };
  const complex amplitude = 0.5 * (mode(2.0) + mode(-2.0));
  const auto fields = run.fields();
  double worst = 0.0;
  for (std::size_t i = 0; i < fields.x.size(); ++i) {
    const double exact = 1.0 + (amplitude * std::exp(complex(0.0, k * fields.x[i]))).imag();
    worst = std::max(worst, std::abs(fields.values[0][i] - exact));
  }
  return worst;
}

}  // namespace

TEST(law, of_shallow_water_converges_to_the_exact_dam_break) {
  const auto error = [](int n, const char* epsilon) {
    return mean_error(finished_case("dam-break", {cells(n), fmt::format("model.epsilon={}", epsilon)}),
                      [](double s) { return depth_of_dam_break(s, 1.0, 0.25); });
  };
  // With a shock in a few cells the error is of first order in L1. The bound 0.8 leaves room for its position
  // within a cell.
  const double coarse = error(100, "0"), fine = error(400, "0");
  EXPECT_GT(0.5 * std::log2(coarse / fine), 0.8);
  EXPECT_LT(fine, 1.5e-3);
  // In the limit ε → 0 the error falls to that of ε = 0. Diffusion spreads the bore by about ε (a² − λ²) over
  // its strength. It spreads the corner of the rarefaction by the square root of ε.
  const double diffuse = error(400, "3e-2"), less = error(400, "3e-3");
  EXPECT_GT(diffuse, 3.0 * less);
  EXPECT_GT(less, fine);
  EXPECT_NEAR(error(400, "1e-8"), fine, 1e-2 * fine);
}

TEST(law, of_a_gas_converges_to_the_exact_solution_of_sod) {
  const auto error = [](int n) { return mean_error(finished_case("euler-sod", {cells(n)}), density_of_sod); };
  // A scheme of fifth order smears the contact over N^(1/6) cells, so it converges with order 5/6. With the
  // shock, of first order, the order is at least 0.75.
  const double coarse = error(100), fine = error(400);
  EXPECT_GT(0.5 * std::log2(coarse / fine), 0.75);
  EXPECT_LT(fine, 2.5e-3);
}

TEST(law, of_colliding_gas_has_the_state_of_the_jump_conditions) {
  const double v = root(0.4, 0.99, [](double w) { return (std::pow(w, -1.4) - 1.0) * (1.0 - w) - 0.25; });
  const auto fields = finished_case("p-system", {}).fields();
  const double shock = 0.6 * std::sqrt((std::pow(v, -1.4) - 1.0) / (1.0 - v));
  for (std::size_t i = 0; i < fields.x.size(); ++i) {
    if (std::abs(fields.x[i]) > shock - 0.1) continue;
    EXPECT_NEAR(fields.values[0][i], v, 1e-3) << fields.x[i];  // as the case says
    EXPECT_NEAR(fields.values[1][i], 0.0, 2e-3) << fields.x[i];
  }
}

TEST(law, in_the_limit_has_the_order_of_the_method_in_a_simple_wave) {
  const auto error = [](int n) {
    const auto run = finished_run(simple_wave, {cells(n)});
    const auto fields = run.fields();
    double worst = 0.0;
    for (std::size_t i = 0; i < fields.x.size(); ++i) {
      double c = 1.0;  // fixed point: the slope of the right-hand side is 3 t 0.1 π < 0.38
      for (int k = 0; k < 60; ++k) c = wave_of_c(fields.x[i] - (3.0 * c - 2.0) * run.t());
      worst = std::max(worst, std::abs(fields.values[0][i] - c * c));
    }
    return worst;
  };
  const double coarse = error(160), fine = error(320);
  EXPECT_GT(std::log2(coarse / fine), 2.85);  // third order in time, fifth in space
  EXPECT_LT(fine, 1e-6);
}

TEST(law, has_the_order_of_the_method_also_where_it_relaxes_slowly) {
  for (const double epsilon : {1.0, 0.1}) {
    const std::string key = fmt::format("model.epsilon={}", epsilon);
    const double coarse = error_of_linear_waves({cells(80), key}, epsilon),
                 fine = error_of_linear_waves({cells(160), key}, epsilon);
    EXPECT_GT(std::log2(coarse / fine), 2.8) << epsilon;
    EXPECT_LT(fine, 2e-5) << epsilon;
  }
}

TEST(law, diffuses_with_epsilon_times_a_squared_minus_lambda_squared) {
  // Both characteristic variables of the linear waves decay with exp(−ε (a² − λ²) π² t) (1 + O(ε)). p
  // therefore keeps its form.
  const auto amplitude = [](double epsilon) {
    const auto fields =
        finished_run(linear_waves, {cells(80), fmt::format("model.epsilon={}", epsilon), "time.cfl=0.02"})
            .fields();
    double sum = 0.0;
    for (std::size_t i = 0; i < fields.x.size(); ++i)
      sum += 2.0 / 80.0 * fields.values[0][i] * std::sin(std::numbers::pi * fields.x[i]);
    return sum;
  };
  const double epsilon = 1e-3, of_waves = std::cos(2.0 * std::numbers::pi * 0.5);
  const double decay =
      -std::log(amplitude(epsilon) / of_waves) / (epsilon * std::pow(std::numbers::pi, 2) * 0.5);
  // The initial layer adds −10 ε (by expansion of the exact solution). The error of the method at Δt =
  // ε/6 is 7e-3.
  EXPECT_NEAR(decay, 9.0 - 4.0, 0.02);
}

TEST(law, keeps_water_at_rest_between_walls_and_sends_waves_back) {
  const overrides walls = {"space.boundary=symmetry", "space.domain=[-1.0, 1.0]", cells(40)};
  overrides rest = walls;
  rest.emplace_back("initial.h=1");
  const auto still = finished_case("dam-break", rest).fields();
  for (const double h : still.values[0]) EXPECT_NEAR(h, 1.0, 1e-14);
  const auto moving = finished_case("dam-break", walls).fields();
  double mass = 0.0;
  for (const double h : moving.values[0]) mass += h / 40.0;
  EXPECT_NEAR(mass, 0.625, 1e-13);
  // The bore met the wall at t = 1/0.94 and came back. The water there is deeper than behind a bore that
  // moves freely.
  EXPECT_GT(moving.values[0].back(), 1.5 * 0.5517);
}

TEST(law, of_a_wall_equals_the_half_of_a_symmetric_problem) {
  const auto whole = finished_case("p-system", {cells(80), "time.end=0.3"}).fields();
  const auto half = finished_case("p-system", {cells(40), "time.end=0.3", "space.domain=[-1.0, 0.0]",
                                               "boundary.left.kind=outflow", "boundary.right.kind=symmetry",
                                               "initial.region.1.where=x > -10", "initial.region.1.u=0.5"})
                        .fields();
  // The mirror image of a WENO scheme differs by rounding errors, which nonlinear weights amplify.
  for (std::size_t i = 0; i < half.x.size(); ++i)
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(half.values[k][i], whole.values[k][i], 1e-10) << i;
}

TEST(law, of_one_variable_equals_the_scalar_relaxation_model) {
  const std::string rest =
      "epsilon = 1e-2\n[space]\ncells = 50\ndomain = [0.0, 2.0]\n[time]\nmethod = \"md-imex-6-3\"\nend = "
      "0.2\ncfl = 0.5\n";
  const auto one = finished_run(
      "[model]\nname = \"conservation-law\"\nvariables = [\"w\"]\nflux = [\"w^2/2\"]\n"
      "speed = 1\n" +
          rest + "[initial]\nw = \"0.4 + 0.3*sin(pi*x)\"\n",
      {});
  const auto other = finished_run("[model]\nname = \"relaxation\"\nflux = \"u^2/2\"\nspeed = 1\n" + rest +
                                      "[initial]\nu1 = \"0.4 + 0.3*sin(pi*x)\"\n",
                                  {});
  EXPECT_EQ(one.state(), other.state());
}

}  // namespace laws_test
