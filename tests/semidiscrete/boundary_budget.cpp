// The boundary budget of a state: its layout, values, and linear combinations.
#include "bgk_case.hpp"

#include <apsis/exec/parallel.hpp>
#include <apsis/semidiscrete/budgeted_problem.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boundary_budget_test {

namespace {

using apsis::boundary_budget;
using apsis::budgeted_problem;
using apsis::budgeted_state;
using apsis::face;
using apsis::field;
using apsis::grid;
using testing::ElementsAre;
using targets = std::vector<apsis::target<budgeted_state, double>>;

/// Returns a gas in the plane with two velocity dimensions and 12 × 12 velocities.
std::unique_ptr<apsis::model> gas_in_plane() {
  apsis::model_config config = apsis::default_config(apsis::find_model("bgk"));
  config.space_dimensions = 2;
  config.parameters["velocity_dimensions"] = config.parameters["degrees_of_freedom"] = 2.0;
  config.velocity = {7.0, 12, apsis::equilibrium_choice::formula};
  return apsis::find_model("bgk").make(config);
}

/// Returns the builder of a periodic square of 4 × 4 cells.
apsis::problem_builder builder_of(const apsis::model& m) {
  apsis::problem_builder builder(m);
  builder.on(grid(2, {4, 4, 1}, {}, {1.0, 1.0, 1.0}))
      .with_reconstruction(apsis::find_reconstruction("upwind1").make());
  return builder;
}

}  // namespace

TEST(boundary_budget, of_every_end_is_the_pressure_on_its_cell_face_in_a_gas_at_rest) {
  // The mesh has 7 × 6 cells, is periodic along y, and has a box of 2 × 1 cells.
  const auto m = gas_in_plane();
  const grid mesh =
      grid(2, {7, 6, 1}, {0.0, 0.0, 0.0}, {0.7, 1.2, 1.0}).with_solids({{{3, 2, 0}, {2, 1, 1}}});
  const auto wall = std::shared_ptr<const apsis::boundary>(apsis::make_boundary("diffuse", *m));
  apsis::problem_builder builder(*m);
  builder.on(mesh)
      .with_reconstruction(apsis::find_reconstruction("upwind1").make())
      .with_boundary(face{0, false}, wall)
      .with_boundary(face{0, true}, wall)
      .with_solid(0, wall);
  field u(mesh.size(), m->components());
  const auto v = m->velocities();
  double pressure = 0.0;  // Σ w v_x² f for these velocities
  for (int cell = 0; cell < mesh.size(); ++cell)
    for (std::size_t j = 0; j < v.weights().size(); ++j) {
      const double vx = v.speeds(0)[j], vy = v.speeds(1)[j];
      const double f = std::exp(-0.5 * (vx * vx + vy * vy));
      if (mesh.solid(cell) < 0) u.row(cell)[j] = f;
      if (cell == 0) pressure += v.weights()[j] * vx * vx * f;
    }
  for (const int threads : {1, 2}) {
    apsis::set_threads(threads);
    const auto equations = builder.build();
    budgeted_problem problem(*equations);
    budgeted_state next{field(mesh.size(), m->components()), {}};
    const double dt = 0.25;
    problem.add_transport(0.0, {u, {}}, targets{{&next, 1.0, dt, true}});
    // Left and right have 6 ends each. The box has 1 left, 1 right, 2 bottom and 2 top ends. In total there
    // are 18 ends of 4 invariants.
    const std::vector<double>& amounts = next.budget.amounts();
    ASSERT_EQ(amounts.size(), 18U * 4U);
    const double dy = 0.2, dx = 0.1;
    for (std::size_t end = 0; end < 18; ++end) {
      const bool along_x = end < 14;
      const bool to_the_right = end < 6 || end == 13, upwards = end >= 16;
      const double force = pressure * dt * (along_x ? dy : dx);
      const double* got = &amounts[4 * end];
      // The amounts are sums of 144 numbers of the size of the pressure.
      EXPECT_NEAR(got[0], 0.0, 1e-15) << end;
      EXPECT_NEAR(got[1], along_x ? (to_the_right ? force : -force) : 0.0, 1e-14) << end;
      EXPECT_NEAR(got[2], along_x ? 0.0 : (upwards ? force : -force), 1e-14) << end;
      EXPECT_NEAR(got[3], 0.0, 1e-14) << end;
    }
  }
  apsis::set_threads(1);
}

TEST(boundary_budget, is_combined_like_the_rows_of_the_states) {
  const boundary_budget u({1.0, 10.0});
  const std::array<double, 2> rates = {0.5, -2.0};
  boundary_budget fresh({7.0}), old({3.0, 4.0}), none;
  fresh.combine(2.0, u, 4.0, rates, true);
  old.combine(0.0, u, 2.0, rates, false);
  none.combine(1.0, u, 0.0, rates, false);
  EXPECT_THAT(fresh.amounts(), ElementsAre(4.0, 12.0));
  EXPECT_THAT(old.amounts(), ElementsAre(4.0, 0.0));
  EXPECT_THAT(none.amounts(), ElementsAre(1.0, 10.0));
  // So far nothing has crossed a face of u.
  boundary_budget first({5.0, 5.0});
  first.combine(1.0, {}, 2.0, rates, true);
  EXPECT_THAT(first.amounts(), ElementsAre(1.0, -4.0));
}

TEST(boundary_budget, of_an_accumulator_that_is_the_state_itself_changes_after_those_of_the_others) {
  const auto m = gas_in_plane();
  const auto equations = apsis::problem_builder(*m)
                             .on(grid(2, {4, 4, 1}, {}, {1.0, 1.0, 1.0}))
                             .with_reconstruction(apsis::find_reconstruction("upwind1").make())
                             .build();
  budgeted_problem problem(*equations);
  budgeted_state u{field(16, m->components()), boundary_budget({1.0, 10.0})}, other = u;
  problem.add_transport(0.0, u, targets{{&u, 0.5, 0.0, true}, {&other, 3.0, 0.0, true}});
  EXPECT_THAT(u.budget.amounts(), ElementsAre(0.5, 5.0));
  EXPECT_THAT(other.budget.amounts(), ElementsAre(3.0, 30.0));
  problem.add_transport(0.0, u, targets{{&u, 2.0, 0.0, false}});
  EXPECT_THAT(u.budget.amounts(), ElementsAre(1.5, 15.0));
}

TEST(boundary_budget, does_not_change_in_collisions) {
  const auto m = gas_in_plane();
  const auto equations = builder_of(*m).with_epsilon([](const apsis::position&) { return 0.1; }).build();
  budgeted_problem problem(*equations);
  budgeted_state u{field(16, m->components()), boundary_budget({1.0, 10.0})};
  for (int cell = 0; cell < 16; ++cell) std::fill_n(u.unknowns.row(cell), m->components(), 1.0 + cell);
  problem.solve_collision(0.0, 0.1, 0.0, u);
  EXPECT_THAT(u.budget.amounts(), ElementsAre(1.0, 10.0));
  budgeted_state sum{field(16, m->components()), boundary_budget({0.5, 0.5})};
  problem.add_collision(0.0, u, targets{{&sum, 2.0, 0.25, false}});
  EXPECT_THAT(sum.budget.amounts(), ElementsAre(2.5, 20.5));
}

}  // namespace boundary_budget_test
