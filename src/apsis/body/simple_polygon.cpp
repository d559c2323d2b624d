#include <apsis/body/internal/simple_polygon.hpp>

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Whether the bounding boxes of two segments are disjoint.
bool are_apart(const position& a, const position& b, const position& c, const position& d) {
  for (std::size_t k = 0; k < 2; ++k)
    if (std::max(a[k], b[k]) < std::min(c[k], d[k]) || std::max(c[k], d[k]) < std::min(a[k], b[k]))
      return true;
  return false;
}

/// Whether both points lie on the same side of the line a → b, and not on it.
bool on_one_side(const position& a, const position& b, const position& c, const position& d) {
  const double first = turn_of(a, b, c), second = turn_of(a, b, d);
  return (first > 0.0 && second > 0.0) || (first < 0.0 && second < 0.0);
}

/// Whether the closed segments a b and c d have a point in common.
bool do_touch(const position& a, const position& b, const position& c, const position& d) {
  return !are_apart(a, b, c, d) && !on_one_side(a, b, c, d) && !on_one_side(c, d, a, b);
}

/// Whether the edges a b and b c overlap: c lies on the ray from b to a.
bool folds_back(const position& a, const position& b, const position& c) {
  const double along = (a[0] - b[0]) * (c[0] - b[0]) + (a[1] - b[1]) * (c[1] - b[1]);
  return turn_of(a, b, c) == 0.0 && along > 0.0;
}

}  // namespace

void check_simple_polygon(const std::vector<position>& corners, const shape_arguments& from) {
  const std::size_t count = corners.size();
  const auto end_of = [&](std::size_t edge) -> const position& { return corners[(edge + 1) % count]; };
  const auto refuse_edges = [&](std::size_t j, std::size_t k) {
    from.refuse(
        "points",
        fmt::format("form edges {} and {} that intersect (edge n joins points n and n + 1)", j + 1, k + 1),
        "reorder or move the points");
  };
  for (std::size_t k = 0; k < count; ++k)
    if (corners[k] == end_of(k))
      from.refuse(
          "points",
          fmt::format("has equal points {} and {} (an edge has the length 0)", k + 1, (k + 1) % count + 1),
          "remove one of them");
  for (std::size_t j = 0; j < count; ++j) {
    if (folds_back(corners[j], end_of(j), end_of((j + 1) % count))) refuse_edges(j, (j + 1) % count);
    for (std::size_t k = j + 2; k < count; ++k)
      if ((k + 1) % count != j && do_touch(corners[j], end_of(j), corners[k], end_of(k))) refuse_edges(j, k);
  }
}

}  // namespace apsis
