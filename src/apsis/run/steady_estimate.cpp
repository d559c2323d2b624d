#include <apsis/run/steady_estimate.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

std::size_t column_of(const numeric_table& table, const std::string& name) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), name);
  return static_cast<std::size_t>(found - table.columns.begin());
}

using points = std::vector<std::pair<double, double>>;  ///< (t, ln change)

/// Returns the slope of the regression line through the points from `first` on.
double slope_of(const points& all, std::size_t first) {
  const auto n = static_cast<double>(all.size() - first);
  double t = 0.0, y = 0.0, tt = 0.0, ty = 0.0;
  for (std::size_t k = first; k < all.size(); ++k) {
    t += all[k].first / n;
    y += all[k].second / n;
  }
  for (std::size_t k = first; k < all.size(); ++k) {
    tt += (all[k].first - t) * (all[k].first - t);
    ty += (all[k].first - t) * (all[k].second - y);
  }
  return ty / tt;
}

}  // namespace

steady_estimate estimate_steady_state(const numeric_table& history) {
  steady_estimate found;
  const std::size_t time = column_of(history, "t"), change = column_of(history, "change");
  if (time == history.columns.size() || change == history.columns.size() || history.rows.empty())
    return found;
  found.change = history.rows.back()[change];
  if (found.change == 0.0) found.distance = 0.0;
  points all;
  for (const auto& row : history.rows)
    if (row[change] > 0.0 && std::isfinite(row[change])) all.emplace_back(row[time], std::log(row[change]));
  if (all.empty() || !(found.change > 0.0)) return found;
  const double twice = all.back().second + std::log(2.0);
  std::size_t first = all.size();
  while (first > 0 && all[first - 1].second < twice) --first;
  if (first == 0) return found;  // the change has not halved
  const double slope = slope_of(all, first - 1);
  if (!(slope < 0.0)) return found;
  found.decay_time = -1.0 / slope;
  found.distance = found.change * found.decay_time;
  return found;
}

std::string to_text(const steady_estimate& estimate, double factor, const std::string& unit) {
  std::string change = fmt::format("the state changes by {:.2g} per unit of time", estimate.change / factor);
  if (estimate.change == 0.0) return change;
  if (!estimate.has_distance())
    return change + ", and its distance from the steady state is unknown: the change does not decay";
  return fmt::format(
      "{}; if this decays on, by a factor e in {:.2g}{}, the state is {:.1g} from its limit, relative",
      change, estimate.decay_time * factor, unit, estimate.distance);
}

}  // namespace apsis
