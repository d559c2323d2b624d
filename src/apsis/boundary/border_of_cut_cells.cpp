#include <apsis/boundary/border_of_cut_cells.hpp>

#include <apsis/boundary/continuation_rows.hpp>

namespace apsis {

void border_of_cut_cells::fill(const face&, double, const pencil_end& rows) const {
  continuation_rows::fill_at_border(three_inside(rows), inward_.data(), rows.components, rows.ghosts);
}

}  // namespace apsis
