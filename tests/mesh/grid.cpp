// Cells in space: pencils, blocks, sizes, and meshes that are refused.
#include <apsis/mesh/grid.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/mesh/phase_space.hpp>

#include <limits>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace grid_test {

TEST(grid, pencils_of_every_direction_visit_every_cell_once) {
  const apsis::grid mesh(3, {3, 4, 5}, {0, 0, 0}, {1, 2, 3});
  for (int direction = 0; direction < 3; ++direction) {
    std::set<int> seen;
    for (int p = 0; p < mesh.pencils(direction); ++p)
      for (int i = 0; i < mesh.cells(direction); ++i) {
        const int cell = mesh.first_cell(direction, p) + i * mesh.stride(direction);
        EXPECT_TRUE(seen.insert(cell).second);
        // The i-th cell of a pencil has the i-th coordinate.
        EXPECT_DOUBLE_EQ(mesh.centre(cell, direction), mesh.spacing(direction) * (i + 0.5));
      }
    EXPECT_EQ(static_cast<int>(seen.size()), mesh.size());
  }
}

TEST(grid, refuses_what_is_no_mesh) {
  EXPECT_THROW(apsis::grid::line(0, 0.0, 1.0), apsis::input_error);
  EXPECT_THROW(apsis::grid::line(4, 1.0, 1.0), apsis::input_error);
  EXPECT_THROW(apsis::grid::line(4, 0.0, std::numeric_limits<double>::infinity()), apsis::input_error);
}

TEST(grid, a_block_has_the_coordinates_of_the_whole_to_the_last_bit) {
  const apsis::grid whole(3, {7, 5, 6}, {-1.0, 0.3, 0.0}, {1.0, 1.7, 1e3});
  const auto part = whole.block({2, 1, 3}, {4, 3, 2}).block({1, 0, 1}, {2, 3, 1});
  EXPECT_EQ(part.size(), 2 * 3 * 1);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(part.spacing(k), whole.spacing(k));
  }
  EXPECT_EQ(part.first(0), 3);
  EXPECT_EQ(part.first(2), 4);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 3; ++j) {
      const int of_whole = ((i + 3) * 5 + j + 1) * 6 + 4;
      EXPECT_EQ(part.centre(i * 3 + j), whole.centre(of_whole));
    }
}

TEST(grid, a_block_lies_inside) {
  const auto line = apsis::grid::line(8, 0.0, 1.0);
  for (const auto& [first, cells] :
       {std::pair{-1, 2}, {0, 0}, {7, 2}, {0, 9}, {1, std::numeric_limits<int>::max()}})
    EXPECT_THROW(static_cast<void>(line.block({first, 0, 0}, {cells, 1, 1})), apsis::input_error) << first;
  EXPECT_EQ(line.block({7, 0, 0}, {1, 1, 1}).centre(0, 0), line.centre(7, 0));
}

TEST(phase_space, has_as_many_unknowns_as_cells_times_components) {
  const apsis::phase_space space(apsis::grid(2, {3, 4, 1}, {0, 0, 0}, {1, 1, 1}),
                                 {{{1.0, -1.0}}, {1.0, 1.0}, 2});
  EXPECT_EQ(space.points(), 3 * 4 * 4);
  EXPECT_EQ(apsis::phase_space(apsis::grid::line(5, 0.0, 1.0)).points(), 0);
}

}  // namespace grid_test
