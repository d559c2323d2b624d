#include <apsis/semidiscrete/tiling.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace apsis {
namespace {

/// With 32 components of u and of three accumulators, these cells fill about half of a cache of 1 MiB.
/// Smaller boxes read more neighbouring cells.
constexpr double cells_of_a_box = 576.0;

std::vector<int> equal_parts(int n, double longest) {
  const int parts = static_cast<int>(std::ceil(n / longest));
  std::vector<int> cuts;
  for (int k = 0; k <= parts; ++k) cuts.push_back(static_cast<int>(static_cast<long>(n) * k / parts));
  return cuts;
}

}  // namespace

tiling::tiling(const grid& mesh, int longest, int parts) : cuts_{{{0, 1}, {0, 1}, {0, 1}}} {
  if (mesh.dimensions() == 1) {
    const part_blocks blocks(mesh.cells(0), longest, parts);
    cuts_[0] = {0};
    for (int k = 0; k < blocks.count(); ++k) cuts_[0].push_back(blocks.end(k));
  } else {
    const double side = std::floor(std::pow(cells_of_a_box, 1.0 / mesh.dimensions()) + 1e-9);
    for (int k = 0; k < mesh.dimensions(); ++k)
      cuts_[static_cast<std::size_t>(k)] = equal_parts(mesh.cells(k), side);
  }
  for (const auto& cuts : cuts_) {
    int longest_part = 0;
    for (std::size_t k = 1; k < cuts.size(); ++k)
      longest_part = std::max(longest_part, cuts[k] - cuts[k - 1]);
    most_cells_ *= longest_part;
  }
}

int tiling::count() const {
  std::size_t count = 1;
  for (const auto& cuts : cuts_) count *= cuts.size() - 1;
  return static_cast<int>(count);
}

cell_box tiling::box(int number) const {
  cell_box box;
  for (std::size_t k = 3; k-- > 0;) {
    const int boxes = static_cast<int>(cuts_[k].size()) - 1;
    const auto at = static_cast<std::size_t>(number % boxes);
    number /= boxes;
    box.first[k] = cuts_[k][at];
    box.cells[k] = cuts_[k][at + 1] - cuts_[k][at];
  }
  return box;
}

}  // namespace apsis
