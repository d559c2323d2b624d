// Rows with negative values become nonnegative and keep their moments.
#include <apsis/steady/negative_values.hpp>

#include "gas_problem.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/processes.hpp>
#include <support/property.hpp>

namespace negative_values_test {
namespace {

using apsis::field;

std::shared_ptr<const apsis::relaxation_model> make_broadwell() {
  const auto& entry = apsis::find_model("broadwell");
  std::shared_ptr<const apsis::model> made = entry.make(apsis::default_config(entry));
  return {made, made->as_relaxation()};
}

std::vector<double> moments_of(const apsis::relaxation_model& equation, const field& f) {
  std::vector<double> omega(static_cast<std::size_t>(equation.moment_count()));
  equation.moments(f.row(0), omega.data());
  return omega;
}

/// Returns the space of a model, with more cells than the tests have rows.
std::shared_ptr<const apsis::problem_builder> space_of(const apsis::relaxation_model& equation) {
  auto made = std::make_shared<apsis::problem_builder>(equation);
  made->on({1, {8, 1, 1}, {0, 0, 0}, {1, 1, 1}})
      .with_discretization("finite-difference")
      .with_reconstruction(apsis::find_reconstruction("upwind1").make());
  return made;
}

/// Returns a moving gas of one cell.
field moving_gas(const apsis::relaxation_model& equation) {
  const int d = equation.velocities().dimensions();
  std::vector<double> omega(static_cast<std::size_t>(equation.moment_count()), 0.0);
  omega[0] = 1.2;
  omega[1] = 1.2 * 0.4;
  omega[static_cast<std::size_t>(d + 1)] = 0.5 * 1.2 * (3.0 * 0.9 + 0.4 * 0.4);
  field f(1, equation.components());
  EXPECT_TRUE(equation.equilibrium(omega.data(), f.row(0)));
  return f;
}

}  // namespace

TEST(negative_values, of_a_gas_are_removed_with_its_moments_kept) {
  for (const char* model : {"bgk", "shakhov", "es-bgk"})
    for (const int d : {1, 2, 3}) {
      const auto equation = make_gas(model, 1, {6.0, d == 3 ? 10 : 16}, d);
      const field gas = moving_gas(*equation);
      check_property("moments", [&] {
        field f = gas;
        // The negative values are up to a millionth of the largest value, also in the tails, where
        // f is smaller.
        std::int64_t negative = 0;
        for (int k = 0; k < f.components(); ++k)
          if (*rc::gen::inRange(0, 5) == 0) {
            f.row(0)[k] = -*rc::gen::element(1e-6, 1e-9, 1e-13, 1e-200) * (1.0 + k % 3);
            ++negative;
          }
        const std::vector<double> before = moments_of(*equation, f);
        // Bumps of another kind may leave no temperature and are discarded.
        RC_PRE(equation->as_gas()->molecules().state(before.data()).admissible());
        const apsis::removed_values removed =
            remove_negative_values(*equation, space_of(*equation)->space(), {0}, f);
        RC_ASSERT(removed.count == negative);
        const std::vector<double> after = moments_of(*equation, f);
        for (std::size_t i = 0; i < after.size(); ++i)
          RC_ASSERT(std::abs(after[i] - before[i]) < 2e-14 * 3.0);
        for (int k = 0; k < f.components(); ++k) RC_ASSERT(f.row(0)[k] >= 0.0);
      });
    }
}

TEST(negative_values, change_a_gas_by_their_size_alone) {
  const auto equation = make_gas("bgk", 1, {6.0, 16}, 2);
  const field gas = moving_gas(*equation);
  field f = gas;
  f.row(0)[0] = -1e-9;  // a corner, where f is below 1e-13
  const apsis::removed_values removed =
      remove_negative_values(*equation, space_of(*equation)->space(), {0}, f);
  EXPECT_EQ(removed.count, 1);
  EXPECT_EQ(removed.lowest, -1e-9);
  for (int k = 0; k < f.components(); ++k) EXPECT_NEAR(f.row(0)[k], gas.row(0)[k], 1e-7);
}

TEST(negative_values, of_a_gas_colder_than_the_gaps_of_its_velocities_change_it_by_their_size_alone) {
  // A Maxwellian of T = 0.04 lies on three velocities of a line. Its tails are below the smallest number.
  const auto equation = make_gas("bgk", 1, {6.0, 31}, 2);
  std::vector<double> omega{1.0, 0.4, 0.0, 0.0};
  omega[3] = 0.5 * (3.0 * 0.04 + 0.4 * 0.4);
  field gas(1, equation->components());
  ASSERT_TRUE(equation->equilibrium(omega.data(), gas.row(0)));
  for (const int corner : {0, 30, equation->components() / 2 - 1}) {
    field f = gas;
    f.row(0)[corner] = -1e-12;
    const std::vector<double> before = moments_of(*equation, f);
    remove_negative_values(*equation, space_of(*equation)->space(), {0}, f);
    for (int k = 0; k < f.components(); ++k) {
      EXPECT_GE(f.row(0)[k], 0.0);
      // A mixture with the equilibrium would change every value by a part of itself.
      EXPECT_NEAR(f.row(0)[k], gas.row(0)[k], 1e-9 * gas.row(0)[k] + 1e-12);
    }
    const std::vector<double> after = moments_of(*equation, f);
    for (std::size_t i = 0; i < after.size(); ++i) EXPECT_NEAR(after[i], before[i], 1e-14);
  }
}

TEST(negative_values, of_a_row_that_no_factor_makes_nonnegative_are_mixed_with_the_equilibrium) {
  // The row has a temperature, but its positive values alone do not: they lie on one velocity.
  const auto equation = make_gas("bgk", 1, {6.0, 16}, 1);
  const field gas = moving_gas(*equation);
  field f(1, equation->components());
  for (int k = 0; k < f.components(); ++k) f.row(0)[k] = 1e-300;
  const auto points = equation->components() / 2;
  f.row(0)[points / 2] = 4.0;
  f.row(0)[points / 2 + 1] = -0.5;
  f.row(0)[points + points / 2] = 4.0;
  const std::vector<double> before = moments_of(*equation, f);
  ASSERT_TRUE(equation->as_gas()->molecules().state(before.data()).admissible());
  EXPECT_EQ(remove_negative_values(*equation, space_of(*equation)->space(), {0}, f).count, 1);
  const std::vector<double> after = moments_of(*equation, f);
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_NEAR(after[i], before[i], 1e-13);
  for (int k = 0; k < f.components(); ++k) EXPECT_GE(f.row(0)[k], 0.0);
}

TEST(negative_values, of_discrete_velocities_change_the_others_by_a_factor) {
  const auto equation = make_broadwell();
  field f(1, equation->components());
  for (int k = 0; k < f.components(); ++k) f.row(0)[k] = 1.0 + k;
  f.row(0)[0] = -1e-3;
  const std::vector<double> before = moments_of(*equation, f);
  EXPECT_EQ(remove_negative_values(*equation, space_of(*equation)->space(), {0}, f).count, 1);
  const std::vector<double> after = moments_of(*equation, f);
  for (std::size_t i = 0; i < after.size(); ++i)
    EXPECT_NEAR(after[i], before[i], 1e-14 * std::abs(before[i]));
  EXPECT_EQ(f.row(0)[0], 0.0);
  for (int k = 1; k < f.components(); ++k) EXPECT_NEAR(f.row(0)[k], 1.0 + k, 1e-2);
}

TEST(negative_values, leave_other_rows_and_cells_as_they_are) {
  const auto equation = make_gas("bgk", 1, {6.0, 16}, 1);
  field f(3, equation->components());
  for (int cell = 0; cell < 3; ++cell)
    for (int k = 0; k < f.components(); ++k) f.row(cell)[k] = moving_gas(*equation).row(0)[k];
  f.row(2)[3] = -1e-5;
  const field before = f;
  EXPECT_EQ(remove_negative_values(*equation, space_of(*equation)->space(), {0, 1}, f).count, 0);
  for (int cell = 0; cell < 3; ++cell)
    for (int k = 0; k < f.components(); ++k) EXPECT_EQ(f.row(cell)[k], before.row(cell)[k]);
}

TEST(negative_values, refuse_a_row_without_equilibrium) {
  const auto equation = make_gas("bgk", 1, {6.0, 16}, 1);
  field f(1, equation->components());
  for (int k = 0; k < f.components(); ++k) f.row(0)[k] = -1.0;
  EXPECT_THROW(remove_negative_values(*equation, space_of(*equation)->space(), {0}, f),
               apsis::numerical_error);
}

TEST(negative_values, are_reported_with_the_cell_of_the_whole_mesh) {
  threads_as_processes::run(2, [](const std::shared_ptr<apsis::communicator>& processes) {
    const auto equation = make_gas("bgk", 1, {6.0, 16}, 1);
    apsis::problem_builder part(*equation);
    part.on({1, {8, 1, 1}, {0, 0, 0}, {1, 1, 1}})
        .with_discretization("finite-difference")
        .with_reconstruction(apsis::find_reconstruction("upwind1").make())
        .shared_by(processes);
    field f(part.mesh().size(), equation->components());
    const field gas = moving_gas(*equation);
    for (int cell = 0; cell < f.cells(); ++cell) std::copy_n(gas.row(0), f.components(), f.row(cell));
    std::fill_n(f.row(1), f.components(), -1.0);  // the second cell of each block of four
    try {
      remove_negative_values(*equation, part.space(), {0, 1, 2, 3}, f);
      ADD_FAILURE() << "accepted";
    } catch (const apsis::numerical_error& failure) {
      EXPECT_EQ(failure.site().cell, processes->rank() == 0 ? 1 : 5);
    }
  });
}

}  // namespace negative_values_test
