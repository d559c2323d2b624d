// Rows beyond the ends of segments, as sweeps access them.
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/domain.hpp>

#include <vector>

#include <gtest/gtest.h>

namespace segments_test {

TEST(segments, continue_across_periodic_faces_until_the_next_solid_cell) {
  // The cells 0 1 | solid 2 | 3 4 form a ring with one cut.
  const apsis::grid mesh = apsis::grid::line(5, 0.0, 1.0).with_solids({{{2, 0, 0}, {1, 1, 1}}});
  const auto periodic = apsis::make_boundary("periodic");
  apsis::domain space(mesh, {{periodic, periodic}}, {apsis::make_boundary("outflow")});
  apsis::field u(5, 1);
  for (int cell = 0; cell < 5; ++cell) u.row(cell)[0] = cell;
  space.reserve(1, 4);
  space.fill_ghosts(0.0, u);
  std::vector<const double*> rows;
  space.segment_rows(u, 0, 0, -4, 5, rows);  // cells 0 and 1; beyond 0 lie 4, 3 and the wall
  std::vector<double> values;
  for (const double* row : rows) values.push_back(*row);
  EXPECT_EQ(values, (std::vector<double>{3, 3, 3, 4, 0, 1, 1, 1, 1}));
  space.segment_rows(u, 0, 1, -2, 6, rows);
  values.clear();
  for (const double* row : rows) values.push_back(*row);
  EXPECT_EQ(values, (std::vector<double>{3, 3, 3, 4, 0, 1, 1, 1}));
}

}  // namespace segments_test
