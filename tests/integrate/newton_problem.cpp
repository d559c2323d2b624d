// Automatic derivatives agree with derivatives by hand. Guarded Newton is tested on stages that are easy,
// stiff, singular, without a root, or not finite.
#include <apsis/integrate/newton_problem.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/integrate/autodiff.hpp>
#include <apsis/integrate/error_control.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <integrate/random.hpp>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace newton_problem_test {

namespace {

using apsis::linear_solver;
using apsis::newton_options;
using apsis::no_transport;
using random_input::magnitude;
using random_input::one_in;
using random_input::uniform;
using row = std::vector<double>;

constexpr auto square_decay = [](const auto& u, auto& out) { out[0] = -10 * u[0] * u[0]; };

TEST(autodiff, derivatives_of_a_coupled_field_agree_with_those_by_hand) {
  // G = (sin(x) y, x² + e^y). From G' and G'' follow Ġ = G'G and Ġ'w = G''[G, w] + G'G'w.
  const auto g = [](const auto& u, auto& out) {
    using std::exp, std::sin;
    out[0] = sin(u[0]) * u[1];
    out[1] = u[0] * u[0] + exp(u[1]);
  };
  check_property("random point and direction", [&] {
    const double x = uniform(-2, 2), y = uniform(-2, 2);
    const Eigen::Vector2d w(uniform(-1, 1), uniform(-1, 1));
    Eigen::Vector2d value(std::sin(x) * y, x * x + std::exp(y));
    Eigen::Matrix2d jacobian, hessian1, hessian2;
    jacobian << std::cos(x) * y, std::sin(x), 2 * x, std::exp(y);
    hessian1 << -std::sin(x) * y, std::cos(x), std::cos(x), 0;
    hessian2 << 2, 0, 0, std::exp(y);
    const Eigen::Vector2d curved(value.dot(hessian1 * w), value.dot(hessian2 * w));
    const Eigen::Vector2d jw = jacobian * w, kw = curved + jacobian * jw, dot = jacobian * value;

    apsis::vector_field<double, decltype(g)> field(g);
    const row u{x, y}, direction{w[0], w[1]};
    row g0(2), g_dot(2), j(2), k(2);
    field.time_derivatives(u, g0, g_dot);
    field.second_product(u, direction, j, k);
    for (Eigen::Index i = 0; i < 2; ++i) {
      const std::size_t s = static_cast<std::size_t>(i);
      // All numbers are below 200 and result from about a dozen roundings.
      RC_ASSERT(std::abs(g0[s] - value[i]) <= 1e-13);
      RC_ASSERT(std::abs(g_dot[s] - dot[i]) <= 1e-12);
      RC_ASSERT(std::abs(j[s] - jw[i]) <= 1e-13);
      RC_ASSERT(std::abs(k[s] - kw[i]) <= 1e-12);
    }
  });
}

TEST(newton_problem, solves_the_cubic_of_square_decay_to_round_off_for_any_step) {
  check_property("v + 10 a v² + 200 |b| v³ = u", [] {
    const double u = magnitude(-6, 3), dt = magnitude(-6, 8);
    const double a = one_in(3) ? 0.0 : dt * uniform(0.1, 2);
    const double b = one_in(3) ? 0.0 : -dt * dt * uniform(0.05, 2);
    apsis::newton_problem problem{no_transport{}, square_decay};
    row state{u};
    problem.solve_collision(0, a, b, state);
    const long double v = state[0];
    RC_ASSERT(v > 0 && v <= u);
    // Every term is positive, so the sum is well conditioned in v.
    RC_ASSERT(std::abs(v + 10 * a * v * v - 200 * b * v * v * v - u) <= 8 * 2.3e-16L * u);
  });
}

TEST(newton_problem, solves_to_round_off_in_long_double) {
  auto problem = apsis::make_newton_problem<std::vector<long double>>(no_transport{}, square_decay);
  for (const long double dt : {1e-4L, 1.0L, 1e8L}) {
    std::vector<long double> state{10};
    problem.solve_collision(0, dt, -dt * dt / 2, state);
    const long double v = state[0];
    EXPECT_LT(std::abs(v + 10 * dt * v * v + 100 * dt * dt * v * v * v - 10), 1e-17L) << dt;
  }
}

TEST(newton_problem, is_exact_for_zero_data_and_for_explicit_stages) {
  apsis::newton_problem problem{no_transport{}, square_decay};
  row u{0};
  problem.solve_collision(0, 1.0, -1.0, u);
  EXPECT_EQ(u, row{0});
  u = {3};
  problem.solve_collision(0, 0.0, 0.0, u);
  EXPECT_EQ(u, row{3});
}

TEST(newton_problem, solves_even_if_squares_underflow) {
  const auto decay = [](const auto& u, auto& out) { out[0] = -u[0]; };
  for (const auto solver : {linear_solver::dense, linear_solver::krylov}) {
    apsis::newton_problem problem(no_transport{}, decay, newton_options{solver});
    row u{1e-200};
    problem.solve_collision(0, 1e9, 0.0, u);
    EXPECT_NEAR(u[0] / (1e-200 / (1 + 1e9)), 1, 1e-14);
  }
}

/// Tridiagonal diffusion with a cubic sink, N unknowns.
constexpr auto reaction_diffusion = [](const auto& u, auto& out) {
  const std::size_t n = u.size();
  for (std::size_t i = 0; i < n; ++i) {
    auto slope = -2 * u[i] - u[i] * u[i] * u[i];
    if (i > 0) slope += u[i - 1];
    if (i + 1 < n) slope += u[i + 1];
    out[i] = slope;
  }
};

TEST(newton_problem, krylov_and_dense_agree) {
  for (const std::size_t n : {2U, 40U, 150U}) {
    row dense(n), krylov(n);
    for (std::size_t i = 0; i < n; ++i) dense[i] = krylov[i] = std::sin(0.1 * static_cast<double>(i)) + 1.5;
    auto with = [](linear_solver solver) {
      return apsis::newton_problem(no_transport{}, reaction_diffusion, newton_options{solver});
    };
    with(linear_solver::dense).solve_collision(0, 3.0, -4.0, dense);
    with(linear_solver::krylov).solve_collision(0, 3.0, -4.0, krylov);
    // Both solutions are exact up to rounding errors. The condition of this stage is below 100.
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(dense[i], krylov[i], 1e-13) << n << " " << i;
  }
}

TEST(newton_problem, automatic_choice_is_krylov_beyond_the_dense_limit) {
  newton_options tiny;
  tiny.dense_limit = 10;
  row u(11, 1.0), v = u;
  apsis::newton_problem(no_transport{}, reaction_diffusion, tiny).solve_collision(0, 1.0, 0.0, u);
  apsis::newton_problem(no_transport{}, reaction_diffusion, newton_options{linear_solver::krylov})
      .solve_collision(0, 1.0, 0.0, v);
  EXPECT_EQ(u, v);
}

TEST(newton_problem, errata_4_singular_stage_of_a_rotation_is_reported) {
  const double w = 3;
  const auto rotation = [w](const auto& u, auto& out) {
    out[0] = w * u[1];
    out[1] = -w * u[0];
  };
  for (const auto solver : {linear_solver::dense, linear_solver::krylov}) {
    apsis::newton_problem problem(no_transport{}, rotation, newton_options{solver});
    const auto solve = [&](double b) {
      row u{1, 2};
      problem.solve_collision(0, 0.0, b, u);
      return u;
    };
    // I − b G'² = (1 − |b| w²) I. For ḋ = −1 this means Δt λ = ±i.
    bad_input::expect_refused({
        {[&] { solve(-(1 + 1e-15) / (w * w)); }, {"singular"}, 3},
    });
    // At a relative distance of 1e-6 the stage is regular and amplifies by 1e6.
    const row near = solve(-(1 + 1e-6) / (w * w));
    EXPECT_NEAR(near[0], -1e6, 1e-3);
    EXPECT_NEAR(near[1], -2e6, 2e-3);
    // With a first-derivative term the stage is regular. In v the terms v and b G'² v cancel, so a G v = −u.
    row u{1, 2};
    problem.solve_collision(0, 0.5, -1 / (w * w), u);
    EXPECT_NEAR(u[0], 2 / (0.5 * w), 1e-14);
    EXPECT_NEAR(u[1], -1 / (0.5 * w), 1e-14);
  }
  apsis::newton_problem problem(no_transport{}, rotation, newton_options{linear_solver::dense});
  row u{1, 2};
  bad_input::expect_refused({
      {[&] { problem.solve_collision(0, 0.0, -1 / (w * w), u); }, {"d > 0"}, 3},
  });
  EXPECT_EQ(u, (row{1, 2}));
}

TEST(newton_problem, does_not_mistake_stiffness_or_units_for_singularity) {
  check_property("fast and slow, large and small variables", [] {
    const double k = magnitude(0, 24), unit = magnitude(-8, 8);
    const auto g = [=](const auto& u, auto& out) {
      out[0] = -u[0];
      out[1] = k * (unit * u[0] - u[1]);
    };
    apsis::newton_problem problem(no_transport{}, g);
    row v{1, 0};
    problem.solve_collision(0, 1.0, 0.0, v);
    RC_ASSERT(std::abs(v[0] - 0.5) <= 1e-15);
    RC_ASSERT(std::abs(v[1] - unit * 0.5 * k / (1 + k)) <= 1e-14 * unit);
  });
}

TEST(newton_problem, iterates_never_leave_the_admissible_set) {
  // √u is undefined below 0, so G itself detects an inadmissible iterate.
  double smallest = 1;
  const auto g = [&smallest](const auto& u, auto& out) {
    using std::sqrt;
    smallest = std::min(smallest, static_cast<double>(u[0]));
    out[0] = -sqrt(u[0]);
  };
  apsis::newton_problem problem{no_transport{}, g};
  problem.with_admissible([](std::span<const double> v) { return v[0] > 0; });
  row u{1e-4};
  problem.solve_collision(0, 10.0, 0.0, u);
  EXPECT_GT(smallest, 0);
  // w = √v solves w² + 10 w = 1e-4.
  const double w = 2e-4 / (10 + std::sqrt(100 + 4e-4));
  EXPECT_NEAR(u[0] / (w * w), 1, 1e-14);  // a few rounding errors
}

TEST(newton_problem, throws_without_an_admissible_root_and_keeps_the_state) {
  apsis::newton_problem problem{no_transport{}, square_decay};
  row u{-5};  // 10 v² + v + 5 = 0 has no real root at all
  bad_input::expect_refused({
      {[&] { problem.solve_collision(0, 1.0, 0.0, u); }, {"no admissible root"}, 3},
  });
  EXPECT_EQ(u, row{-5});
  problem.with_admissible([](std::span<const double> v) { return v[0] >= 0; });
  u = {-1e-3};  // 10 v² + v + 1e-3 = 0 has two negative ones
  bad_input::expect_refused({
      {[&] { problem.solve_collision(0, 1.0, 0.0, u); }, {"no admissible root"}, 3},
  });
  EXPECT_EQ(u, row{-1e-3});
  bad_input::expect_refused({
      {[&] { problem.solve_collision(0, 0.0, 0.0, u); }, {"not admissible"}, 3},
  });
}

// Extrapolation subtracts results of different substeps. A step can be negative although none of
// its stages is.
TEST(newton_problem, steps_to_a_tolerance_stay_admissible_with_every_method) {
  for (const bool guarded : {false, true}) {
    apsis::newton_problem problem(apsis::no_transport{}, [](const auto& u, auto& g) {
      g[0] = -1e4 * u[0];
      g[1] = 1e4 * u[0] - u[1];
    });
    if (guarded) problem.with_admissible([](std::span<const double> v) { return v[0] >= 0 && v[1] >= 0; });
    const auto& m = apsis::find_method("extrapolated-euler-4");
    apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
    apsis::step_controller<double> control(1e-2, apsis::estimate_of(m).order);
    const apsis::component_tolerances<double> distance(1, 1);
    std::vector<double> u{1, 0};
    double least = 0;
    apsis::integrate_to_tolerance(march, u, 0.0, 1.0, apsis::step_rule<double>::unlimited(), control,
                                  distance, [&](long, double, double, const std::vector<double>& now) {
                                    least = std::min({least, now[0], now[1]});
                                  });
    EXPECT_EQ(least >= 0, guarded) << least;
    EXPECT_NEAR(u[1], std::exp(-1.0), 1e-2);
  }
}

TEST(newton_problem, says_that_no_step_is_admissible) {
  apsis::newton_problem problem(apsis::no_transport{},
                                [](const auto& u, auto& g) { g[0] = -1.0 - 0.0 * u[0]; });
  problem.with_admissible([](std::span<const double> v) { return v[0] >= 0; });
  const auto& m = apsis::find_method("kutta-4");
  bad_input::expect_refused({{[&] {
                                apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
                                apsis::step_controller<double> control(1e-2, apsis::estimate_of(m).order);
                                std::vector<double> u{0};
                                apsis::integrate_to_tolerance(march, u, 0.0, 1.0,
                                                              apsis::step_rule<double>::unlimited(), control,
                                                              apsis::component_tolerances<double>(1, 1));
                              },
                              {"the result of a step is not admissible"},
                              3}});
}

TEST(newton_problem, accepts_an_inadmissible_explicit_part_if_the_root_is_admissible) {
  const auto g = [](const auto& u, auto& out) { out[0] = 1 - u[0]; };
  apsis::newton_problem problem{no_transport{}, g};
  problem.with_admissible([](std::span<const double> v) { return v[0] >= 0; });
  row u{-0.5};
  problem.solve_collision(0, 1.0, 0.0, u);
  EXPECT_NEAR(u[0], 0.25, 1e-16);
}

TEST(newton_problem, reports_nan_with_its_component) {
  const auto g = [](const auto& u, auto& out) {
    using std::sqrt;
    out[0] = -u[0];
    out[1] = -sqrt(u[1]);
  };
  apsis::newton_problem problem{no_transport{}, g};
  row u{1, -1};
  bad_input::expect_refused({
      {[&] { problem.solve_collision(0, 1.0, 0.0, u); }, {"component 1"}, 3},
  });
  u = {std::nan(""), 1};
  bad_input::expect_refused({
      {[&] { problem.solve_collision(0, 1.0, 0.0, u); }, {"component 0"}, 3},
      {[&] { problem.solve_collision(0, 0.0, 0.0, u); }, {"component 0"}, 3},
  });
}

TEST(newton_problem, throws_at_the_iteration_limit) {
  newton_options few;
  few.max_iterations = 3;
  apsis::newton_problem problem{no_transport{}, square_decay, few};
  row u{10};
  bad_input::expect_refused({
      {[&] { problem.solve_collision(0, 1e8, -1e16, u); }, {"3 iterations"}, 3},
  });
}

}  // namespace

namespace {

/// Integrates with imdrk-9-5, with relative and absolute tolerances of 1e-6.
template <class G>
apsis::integration_result<double> solve_stiff(const G& g, std::vector<double>& u, double end,
                                              long& rejected) {
  apsis::newton_problem problem(apsis::no_transport{}, g);
  const apsis::method& m = apsis::find_method("imdrk-9-5");
  apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
  apsis::step_controller<double> control(1e-6, m.embedded->order);
  const auto distance = [](const std::vector<double>& a, const std::vector<double>& b) {
    double largest = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k)
      largest = std::max(largest, std::abs(a[k] - b[k]) / (std::abs(a[k]) + 1e-6));
    return largest;
  };
  const auto done = apsis::integrate_to_tolerance(march, u, 0.0, end, apsis::step_rule<double>::unlimited(),
                                                  control, distance);
  rejected = control.rejected();
  return done;
}

}  // namespace

TEST(newton_problem, follows_a_slow_manifold_in_steps_far_beyond_the_relaxation_time) {
  // Van der Pol's equation in Liénard time with ε = 1e-6. A full Newton step leaves the manifold; the new
  // residual is (Δt/ε)² times the square of the old one. With backtracking on the residual alone, Newton's
  // method crept along the manifold and failed after 200 iterations. The integration took 6300 steps.
  std::vector<double> u{2.0, -0.66};
  long rejected = 0;
  const auto done = solve_stiff(
      [](const auto& v, auto& out) {
        out[0] = v[1];
        out[1] = ((1 - v[0] * v[0]) * v[1] - v[0]) / 1e-6;
      },
      u, 2.0, rejected);
  EXPECT_LT(done.steps, 2000);
  EXPECT_LT(rejected, done.steps / 8);
  // Hairer & Wanner, Solving Ordinary Differential Equations II, section IV.10: y(2) for y(0) = (2, −0.66).
  EXPECT_NEAR(u[0], 0.1706167732170483e1, 1e-5);
  EXPECT_NEAR(u[1], -0.8928097010247975, 1e-5);
}

TEST(SLOW_newton_problem, reaches_the_end_of_robertson_s_problem) {
  // Steps grow over sixteen decades. The residuals of the last stages are rounding errors of numbers near
  // 1e5. A Newton method with a smaller absolute tolerance would never end.
  std::vector<double> u{1.0, 0.0, 0.0};
  long rejected = 0;
  const auto done = solve_stiff(
      [](const auto& v, auto& out) {
        const auto first = -0.04 * v[0] + 1e4 * v[1] * v[2], third = 3e7 * v[1] * v[1];
        out[0] = first;
        out[1] = -1.0 * first - third;
        out[2] = third;
      },
      u, 1e11, rejected);
  EXPECT_EQ(done.t, 1e11);
  // Mazzia & Magherini, Test Set for Initial Value Problem Solvers (2008), problem ROBER. The absolute
  // tolerance of 1e-6 is far above u[0] and u[1].
  EXPECT_NEAR(u[0], 0.2083340149701255e-7, 1e-5);
  EXPECT_NEAR(u[1], 0.8333360770334713e-13, 1e-10);
  EXPECT_NEAR(u[2], 0.9999999791665050, 1e-5);
  EXPECT_NEAR(u[0] + u[1] + u[2], 1.0, 1e-12);
}

}  // namespace newton_problem_test
