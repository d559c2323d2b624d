// Orders in space and time together at Δt = r Δt_FE, between moving plates of different temperatures.
#include <apsis/study/convergence.hpp>

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace wall_orders_test {

using namespace apsis;

namespace {

/// Returns the last slope of differences to the next finer run.
double slope(const std::string& name, const std::string& cells, error_norm norm,
             std::vector<std::string> overrides) {
  const convergence_study study{.case_name = name,
                                .overrides = std::move(overrides),
                                .vary = {parse_vary("space.cells=" + cells)},
                                .reference = parse_reference("next"),
                                .norm = norm};
  return converge(study).blocks.front().rows.back().rate;
}

// The cell at the wall is one of N, so its error of order p − 1 has the weight Δx. The l1 norm thus shows the
// order inside.
constexpr double inside = 2.85, at_the_wall = 1.9;  // 3 and 2, changed by the next term

}  // namespace

/// Expects third order up to the wall. The error of the wall cell is smaller than others at these sizes.
void expect_third_order(const std::string& formulation) {
  for (const error_norm norm : {error_norm::l1, error_norm::linf})
    EXPECT_GT(slope("benchmarks/heated-wall", "40,80", norm, {"space.formulation=" + formulation}), inside);
}

TEST(walls, have_third_order_where_plates_start_to_move_and_to_heat) {
  expect_third_order("finite-difference");
}

TEST(SLOW_walls, have_third_order_where_plates_start_to_move_and_to_heat) {
  expect_third_order("finite-volume");
}

TEST(walls, have_third_order_inside_at_small_epsilon) {
  for (const char* model : {"bgk", "shakhov", "es-bgk"})
    EXPECT_GT(slope("benchmarks/carried-gas", "20,40", error_norm::l1, {std::string("model.name=") + model}),
              inside)
        << model;
}

TEST(walls, have_second_order_in_the_cells_next_to_them_at_small_epsilon) {
  for (const char* model : {"bgk", "shakhov", "es-bgk"})
    EXPECT_GT(
        slope("benchmarks/carried-gas", "20,40", error_norm::linf, {std::string("model.name=") + model}),
        at_the_wall)
        << model;
}

TEST(SLOW_walls, have_third_order_in_cell_averages_next_to_them_at_small_epsilon) {
  // In averages the flux v f at the wall is exact.
  EXPECT_GT(slope("benchmarks/carried-gas", "20,40", error_norm::linf, {"space.formulation=finite-volume"}),
            inside);
}

TEST(walls, have_the_limit_scheme_as_epsilon_vanishes_in_steps_that_do_not_depend_on_it) {
  for (const char* model : {"bgk", "shakhov", "es-bgk"}) {
    const convergence_study study{.case_name = "benchmarks/heated-wall",
                                  .overrides = {std::string("model.name=") + model, "space.cells=20"},
                                  .vary = {parse_vary("model.epsilon=1e-4,1e-5,1e-6,1e-8,1e-12")},
                                  .reference = parse_reference("model.epsilon=0"),
                                  .norm = error_norm::l1};
    const auto rows = converge(study).blocks.front().rows;
    for (std::size_t k = 1; k + 1 < rows.size(); ++k) {
      EXPECT_NEAR(rows[k].rate, 1.0, k == 1 ? 0.1 : 0.02) << model << rows[k].values.front();
      EXPECT_EQ(rows[k].steps, rows[0].steps) << model;
    }
    // For 1e-12 the error is 1e-12 times the factor of the other rows, below the rounding of sixty steps.
    EXPECT_LT(rows.back().error, 2e-11) << model;
    EXPECT_EQ(rows.back().steps, rows[0].steps) << model;
  }
}

}  // namespace wall_orders_test
