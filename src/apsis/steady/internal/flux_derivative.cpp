#include <apsis/steady/internal/flux_derivative.hpp>

namespace apsis {
namespace {

/// Adds the cell next to `cell`. Beyond the gas it adds the value on the parabola through three cells inside,
/// or on a line or constant if there are fewer cells.
void add_neighbour(const cell_links& links, int direction, bool upper, int cell, double weight,
                   weighted_cells& to) {
  if (const int other = links.next_or_image(direction, upper, cell); other >= 0) return to.add(other, weight);
  const int second = links.next(direction, !upper, cell),
            third = second < 0 ? -1 : links.next(direction, !upper, second);
  if (third >= 0) {
    to.add(cell, 3.0 * weight);
    to.add(second, -3.0 * weight);
    to.add(third, weight);
  } else if (second >= 0) {
    to.add(cell, 2.0 * weight);
    to.add(second, -weight);
  } else {
    to.add(cell, weight);
  }
}

}  // namespace

weighted_cells edge_of(const cell_links& links, int direction, bool upper, int cell, bool first_order) {
  weighted_cells found;
  if (first_order) {
    found.add(cell, 1.0);
    return found;
  }
  found.add(cell, 5.0 / 6.0);
  add_neighbour(links, direction, upper, cell, 1.0 / 3.0, found);
  add_neighbour(links, direction, !upper, cell, -1.0 / 6.0, found);
  return found;
}

}  // namespace apsis
