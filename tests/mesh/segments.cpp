// Solid boxes cut pencils into segments.
#include <apsis/mesh/segments.hpp>

#include <apsis/core/errors.hpp>

#include <array>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace segments_test {

namespace {

using apsis::cell_box;
using apsis::grid;

grid random_mesh() {
  const int dimensions = *rc::gen::inRange(1, 4);
  std::array<int, 3> cells = {1, 1, 1};
  for (int k = 0; k < dimensions; ++k) cells[static_cast<std::size_t>(k)] = *rc::gen::inRange(2, 9);
  std::vector<cell_box> boxes;
  const int count = *rc::gen::inRange(0, 4);
  for (int n = 0; n < count; ++n) {
    cell_box box;
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k) {
      box.first[k] = *rc::gen::inRange(0, cells[k]);
      box.cells[k] = *rc::gen::inRange(1, cells[k] - box.first[k] + 1);
    }
    boxes.push_back(box);
  }
  const grid mesh(dimensions, cells, {0, 0, 0}, {1, 1, 1});
  try {
    return mesh.with_solids(boxes);
  } catch (const apsis::input_error&) {  // no cell is left
    return mesh;
  }
}

/// Returns the number of a cell with these indices.
int number_of(const grid& mesh, const std::array<int, 3>& at) {
  return (at[0] * mesh.cells(1) + at[1]) * mesh.cells(2) + at[2];
}

bool in_box(const cell_box& box, const std::array<int, 3>& at) {
  for (std::size_t k = 0; k < 3; ++k)
    if (at[k] < box.first[k] || at[k] >= box.first[k] + box.cells[k]) return false;
  return true;
}

}  // namespace

RC_GTEST_PROP(segments, contain_every_cell_of_the_gas_once, ()) {
  const grid mesh = random_mesh();
  std::set<int> gas;
  for (int i = 0; i < mesh.cells(0); ++i)
    for (int j = 0; j < mesh.cells(1); ++j)
      for (int k = 0; k < mesh.cells(2); ++k) {
        bool solid = false;
        for (const auto& box : mesh.solids()) solid = solid || in_box(box, {i, j, k});
        if (!solid) gas.insert(number_of(mesh, {i, j, k}));
      }
  std::set<int> ranges;
  for (const auto& [begin, end] : mesh.fluid())
    for (int cell = begin; cell < end; ++cell) RC_ASSERT(ranges.insert(cell).second);
  RC_ASSERT(ranges == gas);
  const apsis::segment_table table(mesh, {false, true, false});
  for (int direction = 0; direction < mesh.dimensions(); ++direction) {
    std::set<int> seen;
    for (const auto& one : table.along(direction))
      for (int i = 0; i < one.cells; ++i)
        RC_ASSERT(seen.insert(one.first + i * mesh.stride(direction)).second);
    RC_ASSERT(seen == gas);
  }
}

RC_GTEST_PROP(segments, end_beside_solid_cells_or_faces_and_know_their_place_there, ()) {
  const grid mesh = random_mesh();
  const std::array<bool, 3> periodic = {*rc::gen::arbitrary<bool>(), *rc::gen::arbitrary<bool>(),
                                        *rc::gen::arbitrary<bool>()};
  const apsis::segment_table table(mesh, periodic);
  for (int direction = 0; direction < mesh.dimensions(); ++direction) {
    const auto& all = table.along(direction);
    const int stride = mesh.stride(direction), n = mesh.cells(direction);
    for (std::size_t number = 0; number < all.size(); ++number)
      for (const bool upper : {false, true}) {
        const auto& one = all[number];
        const auto& end = one.ends[upper ? 1 : 0];
        const int beside = upper ? one.offset + one.cells : one.offset - 1;
        const int pencil_first = one.first - one.offset * stride;
        const bool outside = beside < 0 || beside >= n;
        if (end.surface < 0) {
          RC_ASSERT(outside && periodic[static_cast<std::size_t>(direction)]);
          const auto& next = all[static_cast<std::size_t>(end.place)];
          RC_ASSERT(next.first - next.offset * stride == pencil_first);
          RC_ASSERT((upper ? next.offset == 0 : next.offset + next.cells == n));
          continue;
        }
        const auto& surface = table.surfaces()[static_cast<std::size_t>(end.surface)];
        RC_ASSERT(surface.segments[static_cast<std::size_t>(end.place)] == static_cast<int>(number));
        RC_ASSERT(surface.where.direction == direction && surface.where.upper == upper);
        const int wrapped = (beside + n) % n;
        RC_ASSERT(surface.solid == (outside && !periodic[static_cast<std::size_t>(direction)]
                                        ? -1
                                        : mesh.solid(pencil_first + wrapped * stride)));
      }
  }
}

TEST(grid, refuses_solid_boxes_that_do_not_fit) {
  const grid mesh(2, {4, 3, 1}, {0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(mesh.with_solids({{{3, 0, 0}, {2, 1, 1}}}), apsis::input_error);
  EXPECT_THROW(mesh.with_solids({{{0, 0, 0}, {0, 1, 1}}}), apsis::input_error);
  EXPECT_THROW(mesh.with_solids({{{0, 0, 0}, {4, 3, 1}}}), apsis::input_error);
}

TEST(grid, blocks_keep_the_parts_of_solid_boxes_with_their_numbers) {
  const grid mesh =
      grid(2, {6, 6, 1}, {0, 0, 0}, {1, 1, 1}).with_solids({{{0, 0, 0}, {1, 1, 1}}, {{2, 2, 0}, {3, 2, 1}}});
  const grid part = mesh.block({3, 1, 0}, {3, 4, 1});
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j)
      EXPECT_EQ(part.solid(number_of(part, {i, j, 0})), mesh.solid(number_of(mesh, {i + 3, j + 1, 0})));
}

}  // namespace segments_test
