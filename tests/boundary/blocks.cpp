// A mesh is divided into blocks for several processes. Rows beyond the ends of segments in a block equal
// those of the whole mesh.
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/domain.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/random_source.hpp>

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>
#include <support/processes.hpp>

namespace blocks_test {

namespace {

using apsis::block_partition;
using apsis::cell_box;
using apsis::communicator;
using apsis::distribution;
using apsis::domain;
using apsis::field;
using apsis::grid;

/// Fills ghost rows from as many rows inside as there are ghost rows, the time and the place.
class deep final : public apsis::boundary {
 public:
  void fill(const apsis::face& where, double t, const apsis::pencil_end& rows) const override {
    for (std::size_t g = 0; g < rows.ghosts.size(); ++g)
      for (int k = 0; k < rows.components; ++k)
        rows.ghosts[g][k] = 2.0 * rows.inside[std::min(g, rows.inside.size() - 1)][k] + t + 0.1 * rows.at[0] +
                            0.2 * rows.at[1] + 0.3 * rows.at[2] + (where.upper ? 1.0 : 0.0);
  }
};

struct problem {
  grid mesh = grid::line(1, 0.0, 1.0);
  std::vector<domain::faces> sides;
  std::vector<std::shared_ptr<const apsis::boundary>> solids;
  int width = 4;
};

problem random_problem(apsis::random_source& random) {
  problem made;
  const int dimensions = random.integer(1, 4);
  const int most = dimensions == 1 ? 24 : dimensions == 2 ? 11 : 7;
  std::array<int, 3> cells = {1, 1, 1};
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k) cells[k] = random.integer(2, most);
  made.mesh = grid(dimensions, cells, {0.1, 0.2, 0.3}, {1.3, 2.2, 3.7});
  const auto periodic = apsis::make_boundary("periodic"), outflow = apsis::make_boundary("outflow");
  const auto one_of = [&]() -> std::shared_ptr<const apsis::boundary> {
    return random.uniform() < 0.5 ? outflow : std::make_shared<const deep>();
  };
  for (int k = 0; k < dimensions; ++k)
    made.sides.push_back(random.uniform() < 0.5 ? domain::faces{periodic, periodic}
                                                : domain::faces{one_of(), one_of()});
  std::vector<cell_box> boxes;
  for (int number = random.integer(0, 4); number > 0; --number) {
    cell_box box;
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k) {
      box.first[k] = random.integer(0, cells[k]);
      box.cells[k] = random.integer(1, std::min(4, cells[k] - box.first[k] + 1));
    }
    boxes.push_back(box);
  }
  try {
    if (!boxes.empty()) made.mesh = made.mesh.with_solids(boxes);
    for (std::size_t k = 0; k < boxes.size(); ++k) made.solids.push_back(one_of());
  } catch (const apsis::input_error&) {
    // The solids would leave no cell of gas, so the mesh stays without them.
  }
  made.width = random.integer(1, 6);
  return made;
}

/// Fills every row with numbers that identify its cell.
field numbered(const grid& whole, const grid& block) {
  field u(block.size(), 3);
  for (int cell = 0; cell < block.size(); ++cell)
    for (int k = 0; k < 3; ++k) u.row(cell)[k] = 10.0 * whole.cell_of(block, cell) + k;
  return u;
}

/// Returns the rows from `width` before to `width` beyond a cell of the gas along a direction.
std::vector<double> neighbourhood(const domain& space, const field& u, int direction, int cell, int width) {
  const auto& segments = space.segments().along(direction);
  const int stride = space.mesh().stride(direction);
  for (int number = 0; number < static_cast<int>(segments.size()); ++number) {
    const auto& one = segments[static_cast<std::size_t>(number)];
    const int at = (cell - one.first) / stride;
    if (cell < one.first || at >= one.cells || one.first + at * stride != cell) continue;
    std::vector<const double*> rows;
    space.segment_rows(u, direction, number, at - width, at + width + 1, rows);
    std::vector<double> values;
    for (const double* row : rows) values.insert(values.end(), row, row + 3);
    return values;
  }
  return {};
}

void expect_the_rows_of_the_whole_mesh(const problem& of, const block_partition& blocks) {
  domain whole({of.mesh}, of.sides, of.solids);
  const field all = numbered(of.mesh, of.mesh);
  whole.reserve(3, of.width);
  whole.fill_ghosts(0.25, all);
  threads_as_processes::run(blocks.processes(), [&](const std::shared_ptr<communicator>& processes) {
    const distribution shared{processes, blocks, of.mesh};
    const grid block = shared.block();
    domain part({block}, of.sides, of.solids, shared);
    part.reserve(3, of.width);
    const field u = numbered(of.mesh, block);
    part.begin_ghosts(0.25, u);
    part.finish_ghosts(0.25, u);
    for (int cell = 0; cell < block.size(); ++cell)
      for (int direction = 0; direction < block.dimensions() && block.solid(cell) < 0; ++direction) {
        const int there = of.mesh.cell_of(block, cell);
        if (neighbourhood(part, u, direction, cell, of.width) !=
            neighbourhood(whole, all, direction, there, of.width))
          throw std::runtime_error(fmt::format("rows beside cell {} along {} differ", there, direction));
      }
  });
}

}  // namespace

TEST(blocks, have_the_rows_of_the_whole_mesh_beside_every_cell) {
  apsis::random_source random(1);
  int tested = 0;
  for (int repetition = 0; repetition < 300; ++repetition) {
    const problem one = random_problem(random);
    const int count = random.integer(2, 9);
    std::unique_ptr<block_partition> blocks;
    try {
      blocks = std::make_unique<block_partition>(one.mesh, count);
    } catch (const apsis::input_error&) {
      continue;  // too few cells
    }
    ++tested;
    ASSERT_NO_THROW(expect_the_rows_of_the_whole_mesh(one, *blocks)) << repetition;
  }
  EXPECT_GT(tested, 200);
}

TEST(blocks, of_a_single_cell_reach_over_several_neighbours) {
  problem one;
  one.mesh = grid::line(7, 0.0, 1.0);
  for (const char* name : {"periodic", "outflow"}) {
    const auto side = apsis::make_boundary(name);
    one.sides = {{side, side}};
    ASSERT_NO_THROW(expect_the_rows_of_the_whole_mesh(one, block_partition(one.mesh, 7))) << name;
  }
}

TEST(blocks, send_no_more_rows_than_their_surfaces_need) {
  // There are 2 x 3 blocks of 6 x 4 cells. The halo of width 4 lies on three sides of the middle blocks, and
  // on two of the others.
  const grid mesh(2, {12, 12, 1}, {0, 0, 0}, {1, 1, 1});
  const block_partition blocks(mesh, {2, 3, 1});
  const auto side = apsis::make_boundary("outflow");
  threads_as_processes::run(6, [&](const std::shared_ptr<communicator>& processes) {
    const distribution shared{processes, blocks, mesh};
    domain part({shared.block()}, {{side, side}, {side, side}}, {}, shared);
    part.reserve(3, 4);
    part.exchange(field(part.mesh().size(), 3));
    const int neighbours = blocks.place(processes->rank())[1] == 1 ? 3 : 2;
    const long rows = 4 * 4 + (neighbours - 1) * 4 * 6;
    if (processes->count().messages != neighbours || processes->count().bytes != rows * 3 * 8)
      throw std::runtime_error(
          fmt::format("{} messages of {} bytes", processes->count().messages, processes->count().bytes));
  });
}

TEST(block_partition, has_the_smallest_surface) {
  const grid cube(3, {64, 64, 64}, {0, 0, 0}, {1, 1, 1}), slab(3, {256, 16, 16}, {0, 0, 0}, {1, 1, 1});
  const auto blocks_of = [](const block_partition& p) {
    return std::array{p.blocks(0), p.blocks(1), p.blocks(2)};
  };
  EXPECT_EQ(blocks_of(block_partition(cube, 8)), (std::array{2, 2, 2}));
  EXPECT_EQ(blocks_of(block_partition(cube, 64)), (std::array{4, 4, 4}));
  EXPECT_EQ(blocks_of(block_partition(slab, 8)), (std::array{8, 1, 1}));
  EXPECT_EQ(blocks_of(block_partition(cube, 7)), (std::array{7, 1, 1}));
}

TEST(block_partition, covers_every_cell_once_with_blocks_that_differ_by_one_cell) {
  const grid mesh(3, {7, 5, 11}, {0, 0, 0}, {1, 1, 1});
  for (const int count : {1, 2, 3, 6, 7, 10, 30}) {
    const block_partition blocks(mesh, count);
    std::vector<int> owners(static_cast<std::size_t>(mesh.size()), 0);
    for (int rank = 0; rank < count; ++rank) {
      const cell_box box = blocks.box(rank);
      EXPECT_EQ(blocks.rank(blocks.place(rank)), rank);
      const grid part = mesh.block(box.first, box.cells);
      for (int cell = 0; cell < part.size(); ++cell)
        ++owners[static_cast<std::size_t>(mesh.cell_of(part, cell))];
      for (int k = 0; k < 3; ++k) {
        const int even = mesh.cells(k) / blocks.blocks(k);
        EXPECT_GE(part.cells(k), even);
        EXPECT_LE(part.cells(k), even + 1);
        EXPECT_EQ(blocks.block_of(k, part.first(k)), blocks.place(rank)[static_cast<std::size_t>(k)]);
      }
    }
    for (const int owned : owners) ASSERT_EQ(owned, 1) << count;
  }
}

TEST(block_partition, that_is_impossible_is_refused_with_the_next_number_of_processes) {
  const grid mesh(2, {4, 3, 1}, {0, 0, 0}, {1, 1, 1});
  bad_input::expect_refused({
      {[&] { block_partition(mesh, 7); }, {"7 processes cannot share the mesh"}},
      {[&] { block_partition(mesh, 7); }, {"start 6"}},
      {[&] { block_partition(mesh, 13); }, {"start 12"}},
      {[&] { block_partition(mesh, {5, 1, 1}); },
       {"5 blocks along direction 1 (it has 4 cells); give 1 to 4"}},
  });
}

}  // namespace blocks_test
