// Fields along lines and on planes of a mesh.
#include <apsis/output/probe.hpp>

#include "support/property.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace probe_test {

using namespace apsis;

namespace {

/// Returns an affine function of the position on a mesh of 5 × 4 × 3 cells of the unit cube.
field_series affine(const std::vector<double>& slopes, bool periodic = false) {
  field_series fields;
  const std::vector<int> cells = {5, 4, 3};
  for (std::size_t k = 0; k < slopes.size(); ++k) {
    mesh_axis axis{std::string(1, "xyz"[k]), {}, periodic};
    for (int i = 0; i < cells[k]; ++i) axis.centres.push_back((i + 0.5) / cells[k]);
    fields.axes.push_back(axis);
  }
  fields.names = fields.labels = {"phi"};
  std::vector<double> values;
  for (std::size_t cell = 0; cell < mesh_size(fields.axes); ++cell) {
    double value = 1.0;
    for (std::size_t k = 0; k < slopes.size(); ++k) value += slopes[k] * centre_of_cell(fields.axes, cell, k);
    values.push_back(value);
  }
  fields.snapshots = {{0.0, {values}}};
  return fields;
}

}  // namespace

TEST(a_probe, is_exact_for_affine_functions_also_in_the_outer_half_of_cells_at_the_ends) {
  check_property("affine functions", [] {
    const auto d = *rc::gen::inRange<std::size_t>(1, 4);
    const auto number = [] { return 0.001 * *rc::gen::inRange(0, 1001); };
    std::vector<double> slopes;
    line_probe line{"p", {}, {}, 7};
    for (std::size_t k = 0; k < d; ++k) {
      slopes.push_back(number() - 0.5);
      line.from.push_back(number());
      line.to.push_back(number());
    }
    const numeric_table table = to_table(affine(slopes), line);
    RC_ASSERT(table.rows.size() == 7U);
    for (std::size_t row = 0; row < 7; ++row) {
      double expected = 1.0, square = 0.0;
      for (std::size_t k = 0; k < d; ++k) {
        const double x = line.from[k] + (line.to[k] - line.from[k]) * static_cast<double>(row) / 6.0;
        RC_ASSERT(std::abs(table.rows[row][1 + k] - x) < 1e-15);
        expected += slopes[k] * x;
        square += (x - line.from[k]) * (x - line.from[k]);
      }
      // The values are differences of numbers near 1, extrapolated over half a cell.
      RC_ASSERT(std::abs(table.rows[row].back() - expected) < 1e-13);
      RC_ASSERT(std::abs(table.rows[row][0] - std::sqrt(square)) < 1e-15);
    }
    for (std::size_t k = 0; k < d; ++k) RC_ASSERT(table.rows.back()[1 + k] == line.to[k]);
  });
}

TEST(a_probe, continues_across_a_periodic_end) {
  // Between the last cell, with centre 0.9, and the first one at 1.1 the mean of 1 + 0.9 s and 1 + 0.1 s is
  // 1.5, at x = 1 and at x = 0.
  const field_series fields = affine({1.0}, true);
  const auto table = to_table(fields, line_probe{"p", {0.0}, {1.0}, 11});
  EXPECT_NEAR(table.rows.front().back(), 1.5, 1e-14);
  EXPECT_NEAR(table.rows.back().back(), 1.5, 1e-14);
  EXPECT_NEAR(table.rows[5].back(), 1.5, 1e-14);
}

TEST(a_probe, beside_cells_without_values_has_those_of_the_nearer_cells) {
  field_series fields = affine({0.0, 0.0});
  auto& values = fields.snapshots[0].values[0];
  for (std::size_t j = 0; j < 4; ++j) values[2 * 4 + j] = std::numeric_limits<double>::quiet_NaN();
  const auto table = to_table(fields, line_probe{"p", {0.0, 0.3}, {1.0, 0.3}, 101});
  for (const auto& row : table.rows) {
    const double x = row[1];
    if (std::abs(x - 0.4) < 1e-9 || std::abs(x - 0.6) < 1e-9) continue;  // the point is on the side of a cell
    EXPECT_EQ(std::isnan(row.back()), x > 0.4 && x < 0.6) << x;
    if (std::isnan(row.back())) continue;
    EXPECT_NEAR(row.back(), 1.0, 1e-15);
  }
}

TEST(a_slice, is_exact_for_affine_functions) {
  const field_series fields = affine({0.25, -0.5, 0.125});
  for (int direction = 0; direction < 3; ++direction)
    for (const double at : {0.0, 0.3, 0.5, 0.99}) {
      const field_series cut = slice_of(fields, {"s", direction, at});
      const auto k = static_cast<std::size_t>(direction);
      EXPECT_EQ(cut.axes[k].centres, std::vector<double>{at});
      const auto& values = cut.snapshots[0].values[0];
      ASSERT_EQ(values.size(), mesh_size(cut.axes));
      for (std::size_t cell = 0; cell < values.size(); ++cell) {
        const double x = centre_of_cell(cut.axes, cell, 0), y = centre_of_cell(cut.axes, cell, 1),
                     z = centre_of_cell(cut.axes, cell, 2);
        // The values are numbers near 1. Some are extrapolated over half a cell.
        EXPECT_NEAR(values[cell], 1.0 + 0.25 * x - 0.5 * y + 0.125 * z, 1e-14) << direction << " " << at;
      }
    }
}

}  // namespace probe_test
