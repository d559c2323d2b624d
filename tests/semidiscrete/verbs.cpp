// combine() and project_to_equilibrium() of semi-discrete problems of every kind of unknowns.
#include <apsis/integrate/verbs.hpp>

#include "bgk_case.hpp"

#include <apsis/semidiscrete/budgeted_problem.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <cmath>
#include <span>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace semidiscrete_verbs_test {

namespace {

using apsis::budgeted_state;
using apsis::field;
using testing::ElementsAre;

constexpr int cells = 12;

/// The three verbs of a problem. The others have their defaults.
struct with_defaults {
  using state = field;
  using real = double;
  apsis::semidiscrete_problem& of;

  void add_transport(double t, const field& u, std::span<const apsis::target<field, double>> targets) {
    of.add_transport(t, u, targets);
  }
  void solve_collision(double t, double a, double b, field& u) { of.solve_collision(t, a, b, u); }
  double forward_euler_step(double t, const field& u) const { return of.forward_euler_step(t, u); }
};

struct kind_of_unknowns {
  const char* discretization;
  bool at_centres;
};
constexpr kind_of_unknowns kinds[] = {
    {"finite-difference", false}, {"finite-volume", false}, {"finite-volume", true}};

std::unique_ptr<apsis::semidiscrete_problem> problem_of(const apsis::model& m, const kind_of_unknowns& kind,
                                                        double epsilon) {
  apsis::problem_builder builder(m);
  builder.on(apsis::grid::line(cells, 0.0, 2.0))
      .with_discretization(kind.discretization)
      .with_reconstruction(apsis::find_reconstruction("weno5-z").make())
      .with_epsilon([epsilon](const apsis::position& x) { return epsilon * (1.0 + x[0]); });
  if (kind.at_centres) builder.with_collisions_at("centres");
  return builder.build();
}

/// Returns smooth data far from equilibrium.
field data_of(const apsis::relaxation_model& m) {
  return sample(apsis::grid::line(cells, 0.0, 2.0), m.components(), false, [&m](double x, int k) {
    const double v = m.velocities().speeds(0)[static_cast<std::size_t>(k)];
    return (1.0 + 0.2 * std::sin(std::numbers::pi * x)) *
           (std::exp(-0.5 * (v - 1.0) * (v - 1.0)) + 0.5 * std::exp(-0.5 * (v + 1.5) * (v + 1.5)));
  });
}

void expect_equal(const field& u, const field& v) {
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < u.stride(); ++k) ASSERT_EQ(u.row(cell)[k], v.row(cell)[k]) << cell << ' ' << k;
}

}  // namespace

TEST(semidiscrete_verbs, combine_like_transport_without_an_evaluation) {
  const auto m = small_bgk();
  const field u = data_of(*m);
  for (const auto& kind : kinds) {
    const auto problem = problem_of(*m, kind, 0.1);
    with_defaults plain{*problem};
    field v = u, native = u, other = u;
    problem->solve_collision(0.0, 0.5, 0.0, v);
    apsis::combine(*problem, {{0.3, &u}, {-1.7, &v}, {1e-9, &u}}, native);
    apsis::combine(plain, {{0.3, &u}, {-1.7, &v}, {1e-9, &u}}, other);
    expect_equal(native, other);
    // The sums are in place, also with another factor than 1.
    apsis::combine(*problem, {{1.0, &native}, {2.0, &v}}, native);
    apsis::combine(*problem, {{-0.5, &native}, {1.0, &u}}, native);
    for (int cell = 0; cell < cells; ++cell)
      for (int k = 0; k < u.components(); ++k)
        ASSERT_NEAR(
            native.row(cell)[k],
            -0.5 * (0.3 * u.row(cell)[k] - 1.7 * v.row(cell)[k] + 2.0 * v.row(cell)[k]) + u.row(cell)[k],
            1e-8);
  }
}

TEST(semidiscrete_verbs, project_to_the_equilibrium_with_the_same_moments) {
  const auto m = small_bgk();
  const auto count = static_cast<std::size_t>(m->moment_count());
  const field u = data_of(*m);
  for (const auto& kind : kinds)
    for (const double epsilon : {1e-12, 1.0, 1e6}) {
      const auto problem = problem_of(*m, kind, epsilon);
      field equilibrium = u;
      apsis::project_to_equilibrium(*problem, 0.0, equilibrium);
      std::vector<double> before(count), after(count);
      double off = 0.0;
      for (int cell = 0; cell < cells; ++cell) {
        m->moments(u.row(cell), before.data());
        m->moments(equilibrium.row(cell), after.data());
        // The moments are sums of 40 numbers of size 1 times v² up to 64.
        for (std::size_t k = 0; k < count; ++k) EXPECT_NEAR(after[k], before[k], 1e-12) << epsilon;
        for (int k = 0; k < u.components(); ++k)
          off = std::max(off, std::abs(equilibrium.row(cell)[k] - u.row(cell)[k]));
      }
      EXPECT_GT(off, 0.05);
      // Point values are then a fixed point of collisions.
      if (kind.discretization != std::string("finite-difference")) continue;
      field again = equilibrium;
      problem->solve_collision(0.0, 0.7, 0.0, again);
      for (int cell = 0; cell < cells; ++cell)
        for (int k = 0; k < u.components(); ++k)
          ASSERT_NEAR(again.row(cell)[k], equilibrium.row(cell)[k], 1e-13);
    }
}

TEST(semidiscrete_verbs, of_a_problem_with_budget_apply_to_both_parts_of_a_state) {
  const auto m = small_bgk();
  const auto equations = problem_of(*m, kinds[0], 0.1);
  apsis::budgeted_problem problem(*equations);
  const field data = data_of(*m);
  budgeted_state u{data, apsis::boundary_budget({1.0, -4.0})}, v{data, apsis::boundary_budget({3.0})},
      sum{data, apsis::boundary_budget({7.0, 7.0})};
  apsis::combine(problem, {{2.0, &u}, {-1.0, &v}}, sum);
  EXPECT_THAT(sum.budget.amounts(), ElementsAre(-1.0, -8.0));
  expect_equal(sum.unknowns, data);
  apsis::combine(problem, {{1.0, &sum}, {1.0, &u}}, sum);
  EXPECT_THAT(sum.budget.amounts(), ElementsAre(0.0, -12.0));
  apsis::project_to_equilibrium(problem, 0.0, u);
  EXPECT_THAT(u.budget.amounts(), ElementsAre(1.0, -4.0));
  field projected = data;
  apsis::project_to_equilibrium(*equations, 0.0, projected);
  expect_equal(u.unknowns, projected);
}

}  // namespace semidiscrete_verbs_test
