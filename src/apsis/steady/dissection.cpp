#include <apsis/steady/dissection.hpp>

#include <apsis/core/index.hpp>
#include <apsis/mesh/cut_cells.hpp>

#include <utility>

namespace apsis {
namespace {

/// Boxes of at most this many cells are not divided.
constexpr int smallest = 8;

class dissection {
 public:
  dissection(const grid& mesh, int reach) : mesh_(mesh), reach_(reach) {}

  void divide(std::array<int, 3> begin, std::array<int, 3> end) {
    int longest = 0, cells = 1;
    for (int d = 0; d < 3; ++d) {
      cells *= end[at(d)] - begin[at(d)];
      if (end[at(d)] - begin[at(d)] > end[at(longest)] - begin[at(longest)]) longest = d;
    }
    const std::size_t k = at(longest);
    if (cells <= smallest || end[k] - begin[k] <= 2 * reach_) return append(begin, end);
    const int middle = (begin[k] + end[k] - reach_) / 2;
    std::array<int, 3> first = end, second = begin, from = begin, to = end;
    first[k] = from[k] = middle;
    second[k] = to[k] = middle + reach_;
    divide(begin, first);
    divide(second, end);
    append(from, to);
  }

  void append(std::array<int, 3> begin, std::array<int, 3> end) {
    const std::size_t before = found_.cells.size();
    for (int x = begin[0]; x < end[0]; ++x)
      for (int y = begin[1]; y < end[1]; ++y)
        for (int z = begin[2]; z < end[2]; ++z) {
          const int cell = x * mesh_.stride(0) + y * mesh_.stride(1) + z * mesh_.stride(2);
          if (has_unknown(mesh_, cell)) found_.cells.push_back(cell);
        }
    if (found_.cells.size() > before) found_.parts.push_back(static_cast<int>(found_.cells.size() - before));
  }

  dissected_mesh take() { return std::move(found_); }

 private:
  const grid& mesh_;
  int reach_;
  dissected_mesh found_;
};

}  // namespace

dissected_mesh dissect(const grid& mesh, const std::array<bool, 3>& periodic, int reach) {
  const std::array<int, 3> begin{};
  std::array<int, 3> end{};
  for (int d = 0; d < 3; ++d) end[at(d)] = mesh.cells(d);
  dissection parts(mesh, reach);
  // A slab at the lower end cuts each periodic direction. The slabs of later directions end at
  // the earlier ones.
  std::array<int, 3> inside = begin;
  for (int d = 0; d < 3; ++d)
    if (periodic[at(d)] && mesh.cells(d) > 2 * reach) inside[at(d)] = reach;
  parts.divide(inside, end);
  for (int d = 0; d < 3; ++d) {
    if (inside[at(d)] == 0) continue;
    std::array<int, 3> from = begin, to = end;
    for (int before = 0; before < d; ++before) from[at(before)] = inside[at(before)];
    to[at(d)] = reach;
    parts.append(from, to);
  }
  return parts.take();
}

}  // namespace apsis
