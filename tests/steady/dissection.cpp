// Orders of elimination. The last slab separates the cells before it.
#include <apsis/steady/dissection.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace dissection_test {
namespace {

constexpr int n = 20;

/// Returns true if the equations of two cells of a square contain each other's moments.
bool are_connected(int a, int b, bool periodic, int reach) {
  int across = std::abs(a / n - b / n), along = std::abs(a % n - b % n);
  if (periodic) across = std::min(across, n - across);
  return (across == 0 && along <= reach) || (along == 0 && across <= reach);
}

/// Returns the sizes of the connected sets of cells, in increasing order.
std::vector<int> connected_sets(std::vector<int> cells, bool periodic, int reach) {
  std::vector<int> sizes;
  while (!cells.empty()) {
    std::vector<int> set{cells.back()};
    cells.pop_back();
    for (std::size_t k = 0; k < set.size(); ++k)
      std::erase_if(cells, [&](int cell) {
        const bool joins = are_connected(set[k], cell, periodic, reach);
        if (joins) set.push_back(cell);
        return joins;
      });
    sizes.push_back(static_cast<int>(set.size()));
  }
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

}  // namespace

TEST(dissection, slabs_as_wide_as_fluxes_reach_separate_halves) {
  for (const bool periodic : {false, true})
    for (const int reach : {1, 2}) {
      const apsis::grid mesh(2, {n, n, 1}, {0, 0, 0}, {1, 1, 1});
      const apsis::dissected_mesh found = apsis::dissect(mesh, {periodic, false, false}, reach);
      std::vector<int> all = found.cells;
      EXPECT_EQ(std::accumulate(found.parts.begin(), found.parts.end(), 0), n * n);
      std::sort(all.begin(), all.end());
      for (int cell = 0; cell < n * n; ++cell) EXPECT_EQ(all[static_cast<std::size_t>(cell)], cell);
      // A ring needs two slabs. The second one ends at the first.
      int separating = 0;
      for (int slab = 0; slab < (periodic ? 2 : 1); ++slab)
        separating += found.parts[found.parts.size() - 1 - static_cast<std::size_t>(slab)];
      EXPECT_EQ(separating, reach * n + (periodic ? reach * (n - reach) : 0));
      const std::vector<int> before(found.cells.begin(), found.cells.end() - separating);
      const std::vector<int> halves = connected_sets(before, periodic, reach);
      ASSERT_EQ(halves.size(), 2u) << periodic << reach;
      EXPECT_GE(halves[0], n * n / 3);
    }
}

}  // namespace dissection_test
