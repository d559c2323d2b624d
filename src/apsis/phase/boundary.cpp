#include <apsis/phase/boundary.hpp>

#include <algorithm>
#include <cstddef>

namespace apsis {

std::shared_ptr<const boundary> boundary::prepared(const face&, const velocity_set&) const {
  return nullptr;
}

std::optional<int> boundary::repeated_cell(int, int) const {
  return std::nullopt;
}

void repeating_boundary::fill(const face&, double, const pencil_end& rows) const {
  const int cells = static_cast<int>(rows.inside.size());
  for (std::size_t g = 0; g < rows.ghosts.size(); ++g) {
    const auto cell = static_cast<std::size_t>(*repeated_cell(static_cast<int>(g), cells));
    std::copy_n(rows.inside[cell], rows.components, rows.ghosts[g]);
  }
}

}  // namespace apsis
