// Groups of cut cells in the blocks of several processes.
#include <apsis/steady/cut_links.hpp>

#include "flows_past_bodies.hpp"

#include <apsis/core/index.hpp>
#include <apsis/semidiscrete/gathered_cells.hpp>
#include <apsis/steady/cell_links.hpp>
#include <apsis/steady/macroscopic_system.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/processes.hpp>

namespace cut_links_test {
namespace {

using namespace flows_past_bodies_test;
using apsis::at;
using apsis::communicator;

/// Sets the numbers of cells that copy another unknown to NaN.
std::vector<double> without_copies(const apsis::cell_links& links, const std::vector<double>& of_cells,
                                   int per_cell) {
  std::vector<double> found(of_cells.size(), std::numeric_limits<double>::quiet_NaN());
  for (const int cell : links.cells())
    std::copy_n(of_cells.begin() + cell * per_cell, per_cell, found.begin() + cell * per_cell);
  return found;
}

/// Returns δω of all cells with J δω = r for moments with waves. Only the root has the result.
std::vector<double> solve_moments(const gas_past_bodies& gas) {
  const int count = gas.equation->moment_count();
  const apsis::cell_links links(gas.builder->space());
  apsis::macroscopic_system system(*gas.equation, *gas.builder, links);
  const auto of_cells = [&](double phase) { return without_copies(links, some_moments(gas, phase), count); };
  system.build(of_cells(0.0), without_copies(links, std::vector<double>(at(gas.mesh().size()), 2.0), 1), 0.0);
  std::vector<double> missing(at(count), 0.1);
  return gather_cells(*gas.builder, system.solve(of_cells(0.5), missing), count);
}

}  // namespace

TEST(cut_links, give_each_group_to_one_process) {
  int without_gas = 0, with_copies_alone = 0;
  for_all_blocks([&](const choices& flow, const blocks_of_mesh& blocks) {
    const gas_past_bodies whole = make(flow);
    const apsis::cell_links all(whole.builder->space());
    const auto& groups = whole.mesh().cut()->groups();
    std::vector<int> owners(at(whole.mesh().size()), 0);
    std::mutex counts;
    threads_as_processes::run(
        blocks[0] * blocks[1] * blocks[2], [&](const std::shared_ptr<communicator>& processes) {
          const gas_past_bodies part = make(flow, processes, blocks);
          const apsis::cell_links links(part.builder->space());
          apsis::cut_links cut(part.builder->space());
          // Owners send their rows to all processes. Other rows are wrong before.
          const auto there = [&](int cell) { return whole.mesh().cell_of(part.mesh(), cell); };
          field rows(part.mesh().size(), 1);
          for (int cell = 0; cell < rows.cells(); ++cell) rows.row(cell)[0] = -1.0;
          for (const int cell : links.cells()) rows.row(cell)[0] = there(cell);
          cut.copy_rows(rows);
          int copies = 0;
          for (int cell = 0; cell < rows.cells(); ++cell) {
            if (part.mesh().solid(cell) >= 0) continue;
            const int group = part.mesh().cut_group(cell);
            copies += group >= 0 ? 1 : 0;
            EXPECT_EQ(rows.row(cell)[0], group < 0 ? there(cell) : groups[at(group)].cells.front());
          }
          const std::lock_guard lock(counts);
          without_gas += links.cells().empty() ? 1 : 0;
          with_copies_alone += copies > 0 && cut.groups().empty() ? 1 : 0;
          for (const int cell : links.cells()) {
            ++owners[at(there(cell))];
            EXPECT_EQ(links.volume(cell), all.volume(there(cell)));
          }
        });
    std::vector<int> expected(owners.size(), 0);
    for (const int cell : all.cells()) expected[at(cell)] = 1;
    EXPECT_EQ(owners, expected);
  });
  EXPECT_GT(without_gas, 0);
  EXPECT_GT(with_copies_alone, 0);
}

TEST(cut_links, give_the_moment_equations_of_one_process) {
  const std::array<std::string, 3> boundaries = {"diffuse", "outflow", "periodic"};
  std::size_t next = 0;
  for_all_blocks([&](choices flow, const blocks_of_mesh& blocks) {
    if (blocks[1] == flow.cells) return;  // columns of single cells suffice
    if (flow.boundary != "periodic") flow.boundary = boundaries[next++ % boundaries.size()];
    flow.boundary_values.clear();
    const std::vector<double> expected = solve_moments(make(flow));
    threads_as_processes::run(blocks[0] * blocks[1] * blocks[2],
                              [&](const std::shared_ptr<communicator>& processes) {
                                EXPECT_EQ(solve_moments(make(flow, processes, blocks)),
                                          processes->is_root() ? expected : std::vector<double>{});
                              });
  });
}

}  // namespace cut_links_test
