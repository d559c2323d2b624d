// Gases of discrete velocities from a table: invariants, the stage equation, equilibria, and refused tables.
#include <apsis/core/errors.hpp>
#include <apsis/core/random_source.hpp>
#include <apsis/model/internal/binary_collisions.hpp>
#include <apsis/model/model_registry.hpp>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace discrete_velocity_test {

namespace {

using apsis::point_batch;
using testing::ElementsAre;
using testing::HasSubstr;
using texts = std::vector<std::string>;

std::unique_ptr<apsis::model> gas(const texts& velocities, const texts& collisions = {}, int dimensions = 1) {
  const auto* entry = apsis::try_find_model("discrete-velocity");
  auto config = apsis::default_config(*entry);
  config.lists["velocities"] = velocities;
  config.lists["collisions"] = collisions;
  config.space_dimensions = dimensions;
  return entry->make(config);
}

std::unique_ptr<apsis::model> nine_velocities() {
  const auto* entry = apsis::try_find_model("discrete-velocity");
  return entry->make(apsis::default_config(*entry));
}

const texts plane = {"1, 0", "-1, 0", "0, 1", "0, -1"};
const texts hexagon = {"1, 0",  "cos(pi/3), sin(pi/3)",     "cos(2*pi/3), sin(2*pi/3)",
                       "-1, 0", "cos(4*pi/3), sin(4*pi/3)", "cos(5*pi/3), sin(5*pi/3)"};

void make(const texts& velocities, const texts& collisions = {}, int dimensions = 1) {
  gas(velocities, collisions, dimensions);
}

/// A table with explicit collisions, so that tests do not depend on the search of the model.
struct table {
  std::vector<std::array<double, 2>> v;
  std::vector<std::array<std::size_t, 4>> collisions;

  /// Adds all elastic collisions of different pairs.
  explicit table(const apsis::model& equation) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(equation.components()); ++j)
      v.push_back({equation.speeds(0)[j], equation.speeds(1)[j]});
    const auto square = [&](std::size_t a, std::size_t b) {
      return v[a][0] * v[a][0] + v[a][1] * v[a][1] + v[b][0] * v[b][0] + v[b][1] * v[b][1];
    };
    const auto near = [](double a, double b) { return std::abs(a - b) < 1e-9; };
    for (std::size_t i = 0; i < v.size(); ++i)
      for (std::size_t j = i + 1; j < v.size(); ++j)
        for (std::size_t k = 0; k < v.size(); ++k)
          for (std::size_t l = k + 1; l < v.size(); ++l)
            if (std::pair(i, j) < std::pair(k, l) && near(square(i, j), square(k, l)) &&
                near(v[i][0] + v[j][0], v[k][0] + v[l][0]) && near(v[i][1] + v[j][1], v[k][1] + v[l][1]))
              collisions.push_back({i, j, k, l});
  }

  /// Returns the symmetric bilinear form B with Q(f) = B(f, f).
  template <class Real>
  std::vector<Real> form(const std::vector<Real>& f, const std::vector<Real>& g) const {
    std::vector<Real> q(f.size());
    for (const auto& [i, j, k, l] : collisions) {
      const Real rate = (f[i] * g[j] + g[i] * f[j] - f[k] * g[l] - g[k] * f[l]) / Real(2);
      q[i] -= rate;
      q[j] -= rate;
      q[k] += rate;
      q[l] += rate;
    }
    return q;
  }
};

std::vector<double> random_row(std::size_t n, apsis::random_source& random) {
  std::vector<double> f(n);
  for (double& value : f) value = random.uniform(0.0, 1.0) < 0.15 ? 0.0 : random.uniform(0.05, 2.0);
  return f;
}

/// Returns the solution of one stage.
std::vector<double> stage(const apsis::model& equation, double a, double b, double epsilon,
                          std::vector<double> u) {
  const point_batch at{.count = 1, .pitch = equation.components(), .epsilon = &epsilon};
  equation.make_collision({.points = 1, .pitch = at.pitch})->solve_stage(a, b, at, u.data());
  return u;
}

double largest(const std::vector<double>& f) {
  double size = 0.0;
  for (const double value : f) size = std::max(size, std::abs(value));
  return size;
}

}  // namespace

TEST(discrete_velocity, stages_of_four_velocities_are_those_in_closed_form_at_every_epsilon) {
  const auto closed = apsis::find_model("broadwell-plane").make({});
  const auto general = gas(plane);
  apsis::random_source random(3);
  for (const double epsilon : {10.0, 1.0, 1e-2, 1e-4, 1e-8, 1e-14, 1e-200, 0.0})
    for (const auto& [a, b] : {std::pair{0.1, 0.0}, {0.1, -0.02}, {0.0, -0.05}})
      for (int repetition = 0; repetition < 20; ++repetition) {
        const auto u = random_row(4, random);
        const auto v = stage(*closed, a, b, epsilon, u), w = stage(*general, a, b, epsilon, u);
        // Newton's method ends at the rounding of terms as large as u. It solves 3 linear equations with a
        // condition of some ten.
        for (std::size_t k = 0; k < 4; ++k)
          EXPECT_NEAR(w[k], v[k], 1e-14 * largest(u)) << epsilon << " " << a;
      }
}

TEST(discrete_velocity, stages_solve_the_equation_that_defines_them) {
  const auto equation = nine_velocities();
  const table of(*equation);
  ASSERT_EQ(of.collisions.size(), 4u + 1u + 1u + 4u);
  apsis::random_source random(7);
  for (const double epsilon : {10.0, 1.0, 0.1, 1e-2, 1e-3, 1e-4})
    for (const auto& [a, b] : {std::pair{0.1, 0.0}, {0.1, -0.002}, {0.1, -0.02}, {0.0, -0.05}})
      for (int repetition = 0; repetition < 20; ++repetition) {
        const auto u = random_row(9, random);
        const auto v = stage(*equation, a, b, epsilon, u);
        // Q̇ = Q'(v) Q(v) = 2 B(v, Q(v)).
        const std::vector<long double> wide(v.begin(), v.end());
        const auto q = of.form(wide, wide), q_dot = of.form(wide, q);
        const long double first = a / epsilon, second = 2.0 * b / epsilon / epsilon;
        // The derivatives of Q and Q̇ multiply an error of 1e-15 in v by about 10 and 100.
        const double allowed =
            static_cast<double>(1e-14L * (1.0L + 10.0L * first + 100.0L * std::abs(second)));
        for (std::size_t k = 0; k < 9; ++k)
          EXPECT_NEAR(static_cast<double>(wide[k] - u[k] - first * q[k] - second * q_dot[k]), 0.0, allowed)
              << epsilon << " " << a << " " << b;
      }
}

TEST(discrete_velocity, stages_keep_the_invariants_to_rounding_and_approach_the_equilibrium) {
  const auto equation = nine_velocities();
  apsis::random_source random(8);
  const std::size_t count = equation->invariants().size();
  for (const double epsilon : {1.0, 1e-3, 1e-7, 1e-11, 1e-15, 1e-100, 0.0})
    for (int repetition = 0; repetition < 30; ++repetition) {
      const auto u = random_row(9, random);
      const auto v = stage(*equation, 0.1, -0.02, epsilon, u), e = stage(*equation, 0.1, -0.02, 0.0, u);
      std::vector<double> before(count), after(count);
      equation->invariant_densities(u.data(), before.data());
      equation->invariant_densities(v.data(), after.data());
      // The invariants are sums of nine terms.
      for (std::size_t k = 0; k < count; ++k) EXPECT_NEAR(after[k], before[k], 4e-15 * before[0]) << epsilon;
      // v − E is about the deviation of u divided by 0.02 (ν/ε)² with ν ≥ 0.1.
      const double distance = std::min(1.0, 1e4 * epsilon * epsilon) + 1e-14;
      for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(v[k], e[k], distance * largest(u)) << epsilon;
    }
}

TEST(discrete_velocity, stages_without_a_second_derivative_are_nonnegative_in_floating_point) {
  const auto equation = nine_velocities();
  apsis::random_source random(12);
  for (const double epsilon : {1e3, 1.0, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 1e-300, 0.0})
    for (int repetition = 0; repetition < 100; ++repetition) {
      auto u = random_row(9, random);
      for (double& value : u)
        if (random.uniform(0.0, 1.0) < 0.3) value *= std::pow(10.0, random.uniform(-300.0, 0.0));
      for (const double value : stage(*equation, 0.3, 0.0, epsilon, u)) EXPECT_GE(value, 0.0) << epsilon;
    }
}

TEST(discrete_velocity, equilibria_are_maxwellians_also_at_the_boundary) {
  const auto equation = nine_velocities();
  apsis::random_source random(9);
  const table of(*equation);
  for (int repetition = 0; repetition < 50; ++repetition) {
    const auto e = stage(*equation, 1.0, 0.0, 0.0, random_row(9, random));
    const auto q = of.form(e, e);
    for (std::size_t k = 0; k < 9; ++k) {
      EXPECT_GE(e[k], 0.0);
      EXPECT_NEAR(q[k], 0.0, 1e-14 * largest(e) * largest(e));  // log e is quadratic in v
    }
  }
  // If all particles have one velocity, none collide.
  for (std::size_t j = 0; j < 9; ++j) {
    std::vector<double> u(9);
    u[j] = 0.7;
    const auto e = stage(*equation, 1.0, -1.0, 0.0, u);
    for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(e[k], u[k], 1e-14);
  }
  const std::vector<double> vacuum(9);
  EXPECT_EQ(stage(*equation, 1.0, -1.0, 0.0, vacuum), vacuum);
}

TEST(discrete_velocity, collisions_never_increase_the_entropy) {
  const auto equation = gas(hexagon);
  apsis::random_source random(10);
  const double epsilon = 1.0;
  const point_batch at{.count = 1, .pitch = 6, .epsilon = &epsilon};
  for (int repetition = 0; repetition < 1000; ++repetition) {
    std::vector<double> f(6), q(6);
    for (double& value : f) value = std::exp(random.uniform(-8.0, 2.0));
    equation->make_collision({.points = 1, .pitch = 6})->evaluate(at, f.data(), q.data());
    double production = 0.0, size = 0.0;
    for (std::size_t k = 0; k < 6; ++k) {
      production += q[k] * std::log(f[k]);
      size += std::abs(q[k] * std::log(f[k]));
    }
    EXPECT_LE(production, 1e-15 * size);
  }
}

TEST(discrete_velocity, invariants_are_found_and_spurious_ones_named) {
  EXPECT_THAT(nine_velocities()->invariants(), ElementsAre("mass", "momentum_x", "momentum_y", "energy"));
  // All particles have the same speed, so energy is half of the mass.
  EXPECT_THAT(gas(plane)->invariants(), ElementsAre("mass", "momentum_x", "momentum_y"));
  // Head-on collisions alone conserve the differences of opposite densities: two momenta and one more
  // invariant (Gatignol 1975).
  EXPECT_THAT(gas(hexagon)->invariants(), ElementsAre("mass", "momentum_x", "momentum_y", "spurious_1"));
  const texts octahedron = {"1, 0, 0", "-1, 0, 0", "0, 1, 0", "0, -1, 0", "0, 0, 1", "0, 0, -1"};
  EXPECT_THAT(gas(octahedron, {}, 3)->invariants(),
              ElementsAre("mass", "momentum_x", "momentum_y", "momentum_z"));
}

TEST(discrete_velocity, data_by_density_velocity_and_temperature_have_them) {
  const auto equation = nine_velocities();
  const auto forms = equation->data_forms();
  std::vector<double> f(9), fields(4);
  for (const auto& given :
       {std::vector{1.3, 0.1, -0.2, 0.5}, {2.0, 0.0, 0.0, 0.9}, {1e-200, 0.5, 0.5, 0.3}}) {
    EXPECT_EQ(forms.front().row(given, f), "");
    equation->macroscopic(f.data(), fields.data());
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(fields[k], given[k], 1e-13 * std::abs(given[k]) + 1e-15 * (k == 0 ? 0.0 : 1.0));
  }
  EXPECT_EQ(forms.front().row(std::vector{1.0, 0.0, 0.0, 1.5}, f),
            "no equilibrium of these velocities has density 1, bulk velocity (0, 0) and temperature 1.5");
  EXPECT_THAT(forms.front().row(std::vector{1.0, 1.2, 0.0, 0.1}, f), HasSubstr("no equilibrium"));
  EXPECT_THAT(forms.front().row(std::vector{-1.0, 0.0, 0.0, 0.5}, f), HasSubstr("no equilibrium"));
  // No particle has a velocity along z, so a bulk velocity along z is refused.
  const auto flat = gas({"1, 0, 0", "-1, 0, 0", "0, 1, 0", "0, -1, 0"});
  std::vector<double> row(4);
  EXPECT_EQ(flat->data_forms().front().row(std::vector{1.0, 0.2, 0.0, 0.0}, row), "");
  EXPECT_THAT(flat->data_forms().front().row(std::vector{1.0, 0.0, 0.0, 0.1}, row),
              HasSubstr("no equilibrium"));
}

TEST(discrete_velocity, all_elastic_collisions_are_found) {
  // Four nested loops find the expected collisions in their order. A turned and shifted lattice has the same
  // collisions up to rounding.
  std::vector<std::vector<double>> lattice, turned;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 1; ++j) {
      lattice.push_back({1.0 * i, 1.0 * j});
      turned.push_back({0.6 * i - 0.8 * j + 0.31, 0.8 * i + 0.6 * j - 7.3});
    }
  std::vector<std::array<int, 4>> expected;
  const int n = static_cast<int>(lattice.size());
  const auto sum = [&](int i, int j) {
    const auto &v = lattice[static_cast<std::size_t>(i)], &w = lattice[static_cast<std::size_t>(j)];
    return std::array{v[0] + w[0], v[1] + w[1], v[0] * v[0] + v[1] * v[1] + w[0] * w[0] + w[1] * w[1]};
  };
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j)
      for (int k = i + 1; k < n; ++k)
        for (int l = k + 1; l < n; ++l)
          if (k != j && l != j && sum(i, j) == sum(k, l)) expected.push_back({i, j, k, l});
  ASSERT_GT(expected.size(), 50U);
  for (const auto& velocities : {lattice, turned}) {
    std::vector<std::array<int, 4>> found;
    const apsis::binary_collisions all(velocities);
    for (const auto& one : all.collisions()) found.push_back({one.i, one.j, one.k, one.l});
    EXPECT_EQ(found, expected);
  }
}

TEST(discrete_velocity, tables_without_sense_are_refused) {
  EXPECT_NO_THROW(make(plane));
  EXPECT_NO_THROW(make(plane, {"1, 2, 3, 4, 0.5"}));
  bad_input::expect_refused({
      {[&] { make(plane, {"1, 3, 2, 4"}); },
       {"model.collisions has [1, 3, 2, 4], which does not conserve momentum and energy (sums of "
        "velocities (1, 1) "
        "and (-1, -1), of their squares 2 and 2); change it"}},
      {[&] { make({"2, 0", "-2, 0", "0, 1", "0, -1"}, {"1, 2, 3, 4"}); },
       {"model.collisions has [1, 2, 3, 4], which does not conserve momentum and energy (sums of "
        "velocities (0, 0) "
        "and (0, 0), of their squares 8 and 2); change it"}},
      {[&] { make(plane, {"1, 2, 2, 1"}); },
       {"model.collisions has [1, 2, 2, 1] (it changes no velocity); remove it"}},
      {[&] { make(plane, {"1, 2, 3, 4", "4, 3, 1, 2"}); },
       {"model.collisions has [1, 2, 3, 4] and [4, 3, 1, 2] (they are the same); give one of them, with "
        "the sum of "
        "the rates"}},
      {[&] { make(plane, {"1, 2, 3, 5"}); },
       {"model.collisions has [1, 2, 3, 5], which names velocity 5 (there are 4, numbered from 1); change "
        "it"}},
      {[&] { make(plane, {"1, 2, 3"}); }, {"an entry with 3 numbers"}},
      {[&] { make(plane, {"1.5, 2, 3, 4"}); }, {"names velocity 1.5"}},
      {[&] { make(plane, {"1, 2, 3, 4, -1"}); }, {"with the rate -1"}},
      {[&] { make({"1, 0", "-1"}); }, {"velocity 2 with 1 component (velocity 1 has 2)"}},
      {[&] { make({"1, 0", "-1, 0", "1, 0"}); },
       {"model.velocities has (1, 0) twice (as velocities 1 and 3); give one of them"}},
      {[&] { make({"1, 0", "-1, 0", "0, 1"}); }, {"admits no collision"}},
      {[&] { make({}); }, {"has 0 velocities"}},
      {[&] { make(plane, {}, 3); }, {"velocities of 2 components (space has 3 dimensions); give 3"}},
  });
}

TEST(discrete_velocity, weak_collisions_beside_strong_ones_are_not_lost) {
  // Two squares do not collide with each other. Their rates are 1 and `slow`, and each must relax as if it
  // were alone. With squares of Δt/ε the matrix of a stage would have entries of size 1 and 1/slow².
  const texts squares = {"1, 0", "-1, 0", "0, 1", "0, -1", "2, 0", "-2, 0", "0, 2", "0, -2"};
  const std::vector<double> first{1.0, 0.5, 0.2, 0.3}, second{0.9, 0.4, 0.1, 0.6};
  std::vector<double> both = first;
  both.insert(both.end(), second.begin(), second.end());
  for (const double slow : {1e-4, 1e-8, 1e-12}) {
    const auto together = gas(squares, {"1, 2, 3, 4", fmt::format("5, 6, 7, 8, {}", slow)});
    const auto alone = gas({"2, 0", "-2, 0", "0, 2", "0, -2"}, {fmt::format("1, 2, 3, 4, {}", slow)});
    for (const double b : {0.0, -0.4}) {
      const auto found = stage(*together, 0.7, b, slow, both);
      const auto wanted = stage(*alone, 0.7, b, slow, second);
      // The tolerance covers a few roundings. Squares left an error of 7e-11 for 1e-8.
      for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(found[4 + j], wanted[j], 1e-14) << slow << " " << b;
      EXPECT_GT(std::abs(found[4] - second[0]), 1e-3) << "the slow collision is frozen, " << slow;
      EXPECT_NEAR(found[0] * found[1], found[2] * found[3], 3 * slow);  // the fast square is near equilibrium
      EXPECT_NEAR(found[0] + found[1] + found[2] + found[3], 2.0, 1e-14);
    }
  }
}

}  // namespace discrete_velocity_test
