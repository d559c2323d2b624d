#include <apsis/run/internal/surface_columns.hpp>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>

namespace apsis {
namespace {

/// Puts row order[k] into place k.
void reorder(surface_table& table, const std::vector<std::size_t>& order) {
  surface_table sorted{table.name, {}, {table.numbers.columns, {}}, table.dimensions, {}};
  for (const std::size_t k : order) {
    sorted.faces.push_back(std::move(table.faces[k]));
    sorted.numbers.rows.push_back(std::move(table.numbers.rows[k]));
    sorted.corners.push_back(std::move(table.corners[k]));
  }
  table = std::move(sorted);
}

std::vector<std::size_t> places_of_rows(const surface_table& table) {
  std::vector<std::size_t> order(table.faces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  return order;
}

/// Begins with the first piece counter-clockwise of an opening of the wall.
void begin_after_gap(surface_table& table) {
  constexpr double least_gap = std::numbers::pi / 3.0;
  const auto& rows = table.numbers.rows;
  std::size_t first = 0;
  double widest = rows.front().front() + 2.0 * std::numbers::pi - rows.back().front();
  for (std::size_t k = 1; k < rows.size(); ++k)
    if (const double gap = rows[k].front() - rows[k - 1].front(); gap > widest) {
      widest = gap;
      first = k;
    }
  if (widest < least_gap) return;
  std::vector<std::size_t> order = places_of_rows(table);
  std::rotate(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(first), order.end());
  reorder(table, order);
}

}  // namespace

void sort_by_first_column(surface_table& table) {
  std::vector<std::size_t> order = places_of_rows(table);
  const auto& rows = table.numbers.rows;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return rows[a].front() < rows[b].front(); });
  reorder(table, order);
}

void measure_around(surface_table& table) {
  const std::size_t area = place_of_name(table.numbers.columns, "area").value();
  begin_after_gap(table);
  double length = 0.0;
  for (auto& row : table.numbers.rows) {
    row.front() = length + 0.5 * row[area];
    length += row[area];
  }
}

}  // namespace apsis
