// The collision contract: closed form and Newton's method solve the same stages. Stage means
// are weighted sums.
#include <apsis/core/errors.hpp>
#include <apsis/core/random_source.hpp>
#include <apsis/model/general_model.hpp>
#include <apsis/model/model_registry.hpp>

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/broadwell_as_general_model.hpp>

namespace point_collision_test {

namespace {

using apsis::point_batch;
using testing::HasSubstr;

std::unique_ptr<apsis::model> made(const std::string& name) {
  const auto* entry = apsis::try_find_model(name);
  return entry->make(apsis::default_config(*entry));
}

std::vector<double> positive_rows(int count, int components, apsis::random_source& random) {
  std::vector<double> rows(static_cast<std::size_t>(count) * static_cast<std::size_t>(components));
  for (double& value : rows) value = random.uniform(0.05, 2.0);
  return rows;
}

std::string failure_of(const std::function<void()>& body, long cell) {
  try {
    body();
  } catch (const apsis::numerical_error& failure) {
    EXPECT_EQ(failure.site().cell, cell);
    return failure.problem();
  }
  return "no failure";
}

}  // namespace

TEST(point_collision, newton_and_closed_form_solve_the_same_stage_at_every_epsilon) {
  const auto closed = made("broadwell");
  const broadwell_as_general_model general;
  apsis::random_source random(11);
  constexpr int points = 4;
  for (const double epsilon : {10.0, 1.0, 1e-2, 1e-4, 1e-6}) {
    const std::vector<double> epsilons(points, epsilon);
    const point_batch at{.count = points, .pitch = 3, .epsilon = epsilons.data()};
    for (const auto& [a, b] : {std::pair{0.1, 0.0}, {0.1, -0.02}, {0.0, -0.05}}) {
      auto u = positive_rows(points, 3, random), v = u;
      closed->make_collision({.points = points, .pitch = 3})->solve_stage(a, b, at, u.data());
      general.make_collision({.points = points, .pitch = 3})->solve_stage(a, b, at, v.data());
      // Newton's method stops at a residual of rounding size. With conserved moments, (1 + μ)(v − E) = u − E.
      // The rounding error of μE relative to u is thus 1e-16 μ/(1 + μ).
      for (std::size_t k = 0; k < u.size(); ++k) EXPECT_NEAR(v[k], u[k], 1e-9) << epsilon << " " << a;
    }
  }
}

TEST(point_collision, evaluates_q_over_epsilon) {
  const auto closed = made("broadwell");
  const broadwell_as_general_model general;
  const std::vector<double> u = {0.7, 0.3, 0.4}, epsilons = {0.05};
  const double q = (0.3 * 0.3 - 0.7 * 0.4) / 0.05;  // f₀² − f₊f₋ over ε
  const point_batch at{.count = 1, .pitch = 3, .epsilon = epsilons.data()};
  for (const apsis::model* equation : std::initializer_list<const apsis::model*>{closed.get(), &general}) {
    std::vector<double> rate(3);
    equation->make_collision({.points = 1, .pitch = 3})->evaluate(at, u.data(), rate.data());
    EXPECT_NEAR(rate[0], q, 1e-14 * 20.0);  // terms of size 10, each with a few rounding errors
    EXPECT_NEAR(rate[1], -q, 1e-14 * 20.0);
    EXPECT_NEAR(rate[2], q, 1e-14 * 20.0);
  }
}

TEST(point_collision, means_are_the_weighted_sums_of_the_solutions) {
  const auto closed = made("broadwell");
  apsis::random_source random(5);
  const std::vector<double> weights = {0.2, 0.5, 0.3};
  for (const std::size_t size : {3u, 2u}) {
    const std::span<const double> of_group(weights.data(), size);
    const auto groups = static_cast<std::size_t>(3);
    const int points = static_cast<int>(groups * size);
    std::vector<double> epsilons(groups * size);
    for (double& epsilon : epsilons) epsilon = std::pow(10.0, random.uniform(-6.0, 1.0));
    const point_batch at{.count = points, .pitch = 3, .epsilon = epsilons.data()};
    const auto u = positive_rows(points, 3, random);
    const auto solver = closed->make_collision({.points = points, .pitch = 3});
    auto solved = u, fused_from = u, plain_from = u;
    solver->solve_stage(0.1, -0.02, at, solved.data());
    std::vector<double> fused(3 * groups), plain(3 * groups);
    solver->solve_stage_means(0.1, -0.02, at, fused_from.data(), of_group, fused.data());
    solver->apsis::point_collision::solve_stage_means(0.1, -0.02, at, plain_from.data(), of_group,
                                                      plain.data());
    for (std::size_t group = 0; group < groups; ++group)
      for (std::size_t k = 0; k < 3; ++k) {
        long double mean = 0.0L;
        for (std::size_t q = 0; q < size; ++q)
          mean += static_cast<long double>(weights[q]) * solved[(group * size + q) * 3 + k];
        EXPECT_NEAR(fused[group * 3 + k], static_cast<double>(mean), 4e-16 * 2.0);
        EXPECT_NEAR(plain[group * 3 + k], static_cast<double>(mean), 4e-16 * 2.0);
      }
  }
}

TEST(point_collision, changes_lead_to_the_solutions_and_never_below_zero) {
  apsis::random_source random(23);
  for (const std::string name : {"bgk", "shakhov", "es-bgk", "broadwell", "discrete-velocity", "decay"}) {
    const auto equation = made(name);
    const int components = equation->components();
    const auto width = static_cast<std::size_t>(components);
    constexpr int points = 5;
    const auto solver = equation->make_collision({.points = points, .pitch = components});
    for (int round = 0; round < 40; ++round) {
      std::vector<double> epsilons(points), u(points * width), change(points * width, -1.0);
      for (double& epsilon : epsilons) epsilon = std::pow(10.0, random.uniform(-14.0, 2.0));
      // A third of the components is large. Others are down to 1e-12 and zero, far from equilibrium.
      for (std::size_t k = 0; k < u.size(); ++k)
        u[k] = k % 3 == 0   ? random.uniform(0.5, 1.0)
               : k % 7 == 1 ? 0.0
                            : std::pow(10.0, random.uniform(-12.0, 0.0));
      const point_batch at{.count = points, .pitch = components, .epsilon = epsilons.data()};
      auto v = u;
      solver->solve_stage(0.1, -0.02, at, v.data());
      solver->solve_stage_changes(0.1, -0.02, at, u.data(), change.data());
      for (std::size_t k = 0; k < u.size(); ++k) {
        // Differences of numbers of this size are rounded. v itself has some rounding errors.
        EXPECT_NEAR(change[k], v[k] - u[k], 1e-15 * (u[k] + std::abs(v[k]))) << name;
        if (v[k] >= 0.0) {
          EXPECT_GE(u[k] + change[k], 0.0) << name;
        }
      }
    }
  }
}

TEST(point_collision, in_the_limit_yields_the_equilibrium_or_fails_with_the_cell) {
  const auto closed = made("broadwell");
  const broadwell_as_general_model general;
  std::vector<double> u = {0.7, 0.3, 0.4, 0.2, 0.2, 0.2}, v = u;
  const std::vector<double> epsilons = {1.0, 0.0};
  const point_batch at{.count = 2, .pitch = 3, .epsilon = epsilons.data(), .first_cell = 7};
  closed->make_collision({.points = 2, .pitch = 3})->solve_stage(0.1, -0.02, at, u.data());
  // For ω = (0.8, 0), E is 0.2 everywhere, so the row is its own equilibrium.
  for (int k = 3; k < 6; ++k) EXPECT_DOUBLE_EQ(u[static_cast<std::size_t>(k)], 0.2);
  const auto newton = general.make_collision({.points = 2, .pitch = 3});
  EXPECT_THAT(failure_of([&] { newton->solve_stage(0.1, -0.02, at, v.data()); }, 8),
              HasSubstr("dt/epsilon or its square is not a finite number"));
  EXPECT_THAT(failure_of([&] { newton->evaluate(at, v.data(), v.data()); }, 8),
              HasSubstr("Q/epsilon is not a finite number"));
  std::vector<double> rate(6);
  EXPECT_THAT(
      failure_of(
          [&] { closed->make_collision({.points = 2, .pitch = 3})->evaluate(at, u.data(), rate.data()); }, 8),
      HasSubstr("Q/epsilon does not exist for epsilon = 0"));
}

TEST(point_collision, a_general_model_has_no_relaxation_time) {
  const broadwell_as_general_model general;
  EXPECT_FALSE(general.has_relaxation_time());
  const std::vector<double> u = {0.7, 0.3, 0.4};
  const auto newton = general.make_collision({.points = 1, .pitch = 3});
  EXPECT_EQ(newton->relaxation_time(u.data(), 0.1), std::numeric_limits<double>::infinity());
  EXPECT_EQ(newton->forward_euler_step(u.data(), 0.1), 0.0);
  const auto closed = made("broadwell");
  EXPECT_TRUE(closed->has_relaxation_time());
  const auto relaxation = closed->make_collision({.points = 1, .pitch = 3});
  EXPECT_DOUBLE_EQ(relaxation->relaxation_time(u.data(), 0.1), 0.1 / 1.7);  // ε/ρ, ρ = 0.7 + 0.6 + 0.4
}

}  // namespace point_collision_test
