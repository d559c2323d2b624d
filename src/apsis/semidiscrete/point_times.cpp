#include <apsis/semidiscrete/point_times.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace apsis {

double smallest_time(const model& equation, const field& u, std::span<const double> epsilon,
                     int points_per_cell, bool keeps_sign, point_time time,
                     std::span<const cell_range> cells) {
  const cell_range all[] = {{0, u.cells()}};
  const auto local = equation.make_collision({1, u.stride(), keeps_sign});
  double result = std::numeric_limits<double>::infinity();
  for (const auto& [begin, end] : cells.empty() ? std::span<const cell_range>(all) : cells)
    for (int cell = begin; cell < end; ++cell)
      for (const double at :
           epsilon.subspan(static_cast<std::size_t>(cell) * static_cast<std::size_t>(points_per_cell),
                           static_cast<std::size_t>(points_per_cell)))
        result = std::min(result, ((*local).*time)(u.row(cell), at));
  return result;
}

}  // namespace apsis
