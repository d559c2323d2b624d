#include <apsis/output/probe.hpp>

#include <apsis/velocity/position.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace apsis {
namespace {

/// Linear interpolation along an axis: (1 − weight) φ[lower] + weight φ[upper].
struct neighbours {
  std::size_t lower = 0, upper = 0;
  double weight = 0.0;
};

neighbours neighbours_of(const mesh_axis& axis, double q) {
  const std::size_t n = axis.centres.size();
  if (n < 2) return {};
  const double first = axis.centres.front(),
               spacing = (axis.centres.back() - first) / static_cast<double>(n - 1);
  const double s = (q - first) / spacing, cell = std::floor(s);
  if (axis.periodic) {
    const auto wrapped = [n](double i) {
      const auto count = static_cast<double>(n);
      return static_cast<std::size_t>(i - count * std::floor(i / count));
    };
    return {wrapped(cell), wrapped(cell + 1.0), s - cell};
  }
  const double inside = std::clamp(cell, 0.0, static_cast<double>(n - 2));
  const auto lower = static_cast<std::size_t>(inside);
  return {lower, lower + 1, s - inside};
}

/// Interpolates linearly. If a value is NaN, the nearer one applies: beside a solid, that of the gas.
double blend(double lower, double upper, double weight) {
  if (weight < 0.5 && std::isnan(upper)) return lower;
  if (weight >= 0.5 && std::isnan(lower)) return upper;
  return (1.0 - weight) * lower + weight * upper;
}

/// Interpolates along the axes k, k + 1, …. `first` is the index of the cell along the axes before k.
double interpolate(const std::vector<mesh_axis>& axes, const std::vector<neighbours>& around,
                   const std::vector<double>& values, std::size_t k, std::size_t first) {
  if (k == axes.size()) return values[first];
  const std::size_t n = axes[k].centres.size();
  const auto [lower, upper, weight] = around[k];
  const double below = interpolate(axes, around, values, k + 1, first * n + lower);
  if (weight == 0.0) return below;
  return blend(below, interpolate(axes, around, values, k + 1, first * n + upper), weight);
}

/// Returns a point of a line; the ends are exact.
position point_of(const line_probe& line, int point) {
  const double part = static_cast<double>(point) / (line.points - 1);
  position x{};
  for (std::size_t k = 0; k < line.from.size(); ++k) x[k] = (1.0 - part) * line.from[k] + part * line.to[k];
  return x;
}

double distance(const line_probe& line, const position& x) {
  double square = 0.0;
  for (std::size_t k = 0; k < line.from.size(); ++k) square += (x[k] - line.from[k]) * (x[k] - line.from[k]);
  return std::sqrt(square);
}

}  // namespace

numeric_table to_table(const field_series& fields, const line_probe& line) {
  const auto& axes = fields.axes;
  const bool several = fields.snapshots.size() > 1;
  numeric_table out;
  if (several) out.columns.emplace_back("t");
  out.columns.emplace_back("s");
  for (const auto& axis : axes) out.columns.push_back(axis.name);
  out.columns.insert(out.columns.end(), fields.names.begin(), fields.names.end());
  for (const auto& snapshot : fields.snapshots)
    for (int point = 0; point < line.points; ++point) {
      const position x = point_of(line, point);
      std::vector<neighbours> around;
      for (std::size_t k = 0; k < axes.size(); ++k) around.push_back(neighbours_of(axes[k], x[k]));
      std::vector<double> row;
      if (several) row.push_back(snapshot.t);
      row.push_back(distance(line, x));
      for (std::size_t k = 0; k < axes.size(); ++k) row.push_back(x[k]);
      for (const auto& values : snapshot.values) row.push_back(interpolate(axes, around, values, 0, 0));
      out.rows.push_back(std::move(row));
    }
  return out;
}

field_series slice_of(const field_series& fields, const plane_slice& plane) {
  const auto direction = static_cast<std::size_t>(plane.direction);
  const auto [lower, upper, weight] = neighbours_of(fields.axes[direction], plane.at);
  field_series out{fields.axes,      fields.names,     fields.labels,     fields.units,
                   fields.unit_of_x, fields.unit_of_t, fields.dimensions, {}};
  out.axes[direction] = {fields.axes[direction].name, {plane.at}};
  std::size_t inner = 1;
  for (std::size_t k = direction + 1; k < fields.axes.size(); ++k) inner *= fields.axes[k].centres.size();
  const std::size_t cells = mesh_size(out.axes), n = fields.axes[direction].centres.size();
  for (const auto& snapshot : fields.snapshots) {
    field_series::snapshot cut{snapshot.t, {}};
    for (const auto& values : snapshot.values) {
      std::vector<double> on_plane;
      for (std::size_t cell = 0; cell < cells; ++cell) {
        const std::size_t first = cell / inner * inner * n + cell % inner;
        const double below = values[first + lower * inner];
        on_plane.push_back(weight == 0.0 ? below : blend(below, values[first + upper * inner], weight));
      }
      cut.values.push_back(std::move(on_plane));
    }
    out.snapshots.push_back(std::move(cut));
  }
  return out;
}

}  // namespace apsis
