#include <apsis/run/internal/surface_columns.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace apsis {
namespace {

/// Moves row order[k] to place k.
void reorder(surface_table& table, const std::vector<std::size_t>& order) {
  surface_table sorted{table.name, {}, {table.numbers.columns, {}}, table.dimensions, {}};
  for (const std::size_t k : order) {
    sorted.faces.push_back(std::move(table.faces[k]));
    sorted.numbers.rows.push_back(std::move(table.numbers.rows[k]));
    sorted.corners.push_back(std::move(table.corners[k]));
  }
  table = std::move(sorted);
}

/// Returns the order of sorted rows along the wall. Lines that begin at an opening come first, then closed
/// lines. Each closed line begins with its first row.
std::vector<std::size_t> order_along(const std::vector<std::vector<position>>& pieces) {
  std::map<position, std::size_t> begins, ends;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    begins.emplace(pieces[k].front(), k);
    ends.emplace(pieces[k].back(), k);
  }
  std::vector<std::size_t> order;
  std::vector<bool> taken(pieces.size(), false);
  const auto follow = [&](std::size_t first) {
    for (auto next = first; !taken[next];) {
      taken[next] = true;
      order.push_back(next);
      if (const auto found = begins.find(pieces[next].back()); found != begins.end()) next = found->second;
    }
  };
  for (const bool closed : {false, true})
    for (std::size_t k = 0; k < pieces.size(); ++k)
      if (closed || !ends.contains(pieces[k].front())) follow(k);
  return order;
}

}  // namespace

void sort_by_first_column(surface_table& table) {
  std::vector<std::size_t> order(table.faces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto& rows = table.numbers.rows;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return rows[a].front() < rows[b].front(); });
  reorder(table, order);
}

void measure_around(surface_table& table, const grid& mesh) {
  const auto& columns = table.numbers.columns;
  const std::size_t area = place_of_name(columns, "area").value(), x = place_of_name(columns, "x").value();
  reorder(table, order_along(table.corners));
  double length = 0.0;
  for (std::size_t k = 0; k < table.corners.size(); ++k) {
    auto& row = table.numbers.rows[k];
    if (k > 0) {
      const position &from = table.corners[k - 1].back(), &to = table.corners[k].front();
      length += std::hypot(to[0] - from[0], to[1] - from[1]);
    }
    const double piece = row[area] / (mesh.measure() * mesh.radius({row[x], row[x + 1], 0.0}));
    row.front() = length + 0.5 * piece;
    length += piece;
  }
}

}  // namespace apsis
