// Studies in two and three dimensions: every direction has its own number of cells.
#include <apsis/study/convergence.hpp>
#include <apsis/study/settings.hpp>

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace convergence_in_the_plane_test {

using namespace apsis;
using kind = convergence_reference::kind;

namespace {

/// u_t + u_x − u_y/2 = 0 carries a smooth wave through a periodic rectangle.
const char* const wave = R"case([model]
name = "conservation-law"
variables = ["u"]
flux = ["u"]
flux_y = ["-0.5*u"]
speed = 2
epsilon = 0
[initial]
u = "1 + 0.3*sin(pi*x)*cos(2*pi*y)"
[space]
cells = [16, 16]
domain = [[0.0, 2.0], [0.0, 1.0]]
reconstruction = "upwind5"
[time]
method = "md-imex-6-3"
end = 0.1
dt = 0.004
)case";

convergence_study study_of(const std::string& cells, const std::string& reference) {
  return {.case_name = "wave",
          .case_text = wave,
          .vary = {parse_vary("space.cells=" + cells)},
          .reference = parse_reference(reference),
          .quantity = "u"};
}

/// Returns the norm (Σ d² Δx Δy)^½ of the difference from u₀(x − ct).
double exact_error(int columns, int rows) {
  const auto run = compute_outcome(parse_case(
      wave, "wave", {"space.cells=[" + std::to_string(columns) + "," + std::to_string(rows) + "]"}));
  constexpr double pi = std::numbers::pi, t = 0.1;
  double sum = 0.0;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      const double x = 2.0 * (i + 0.5) / columns, y = (j + 0.5) / rows;
      const double d = run.fields.values[0][static_cast<std::size_t>(i * rows + j)] - 1.0 -
                       0.3 * std::sin(pi * (x - t)) * std::cos(2.0 * pi * (y + 0.5 * t));
      sum += d * d;
    }
  return std::sqrt(sum * 2.0 / (columns * rows));
}

}  // namespace

TEST(convergence_in_the_plane, shows_the_order_of_the_scheme_and_the_size_of_the_error) {
  for (const std::string reference : {"space.cells=[48,48]", "next", "space+time"}) {
    const auto table = converge(study_of("[12,12],[24,24]", reference));
    EXPECT_EQ(table.h_name, "Δx");
    const auto& rows = table.blocks.at(0).rows;
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].h, 2.0 / 12);
    EXPECT_EQ(rows[1].h, 2.0 / 24);
    EXPECT_NEAR(rows[1].rate, 5.0, 0.15) << reference;
    // Differences from a mesh that is twice as fine are 1/32 smaller than the error.
    EXPECT_NEAR(rows[0].error / exact_error(12, 12), 1.0, 0.05) << reference;
    EXPECT_NEAR(rows[1].error / exact_error(24, 24), 1.0, 0.05) << reference;
  }
}

TEST(convergence_in_the_plane, directions_may_have_different_ratios) {
  // The error of the coarse meshes is that of y, which alone is refined.
  const auto table = converge(study_of("[24,8],[24,16]", "space.cells=[48,48]"));
  const auto& rows = table.blocks.at(0).rows;
  EXPECT_EQ(rows[0].h, 1.0 / 8);
  EXPECT_EQ(rows[1].h, 1.0 / 16);
  EXPECT_NEAR(rows[0].error / exact_error(24, 8), 1.0, 0.05);
  EXPECT_NEAR(rows[1].error / exact_error(24, 16), 1.0, 0.05);
  // The next run is finer by the last ratio in each direction.
  const convergence_table next = convergence(study_of("[16,8],[24,16]", "next")).table();
  EXPECT_EQ(next.runs, 3);
}

TEST(convergence_in_the_plane, meshes_that_are_coarser_in_one_direction_are_refused) {
  const auto plan = [](const std::string& cells, const std::string& reference) {
    return [study = study_of(cells, reference)] { const convergence all(study); };
  };
  // The totals of cells are equal.
  bad_input::expect_refused({
      {plan("[20,20]", "space.cells=[40,10]"),
       {"a reference with 10 cells along y cannot be compared with a run of 20 (it is coarser); choose a "
        "multiple of 20 along y"}},
      {plan("[40,10]", "space.cells=[20,20]"),
       {"a reference with 20 cells along x cannot be compared with a run of 40 (it is coarser); choose a "
        "multiple of 40 along x"}},
      {plan("[40,10],[20,20]", "next"), {"along y"}},
  });
}

TEST(convergence_in_the_plane, a_resolution_has_a_direction) {
  const auto c = parse_case(wave, "wave", {"space.cells=[16,50]"});
  EXPECT_EQ(resolution(c, "space.cells"), 2.0 / 16);
  EXPECT_EQ(resolution(c, "space.cells", 1), 1.0 / 50);
}

}  // namespace convergence_in_the_plane_test
