#include <apsis/run/distribution_rows.hpp>

#include <apsis/config/output_tables.hpp>

#include <utility>
#include <vector>

namespace apsis {
namespace {

/// Every stride-th cell of a mesh in each direction.
struct thinned_mesh {
  std::vector<mesh_axis> axes;
  std::vector<int> cells;  ///< numbers in the whole mesh
};

thinned_mesh thinned(const simulation& run, int stride) {
  if (!run.has_space()) return {{}, {0}};
  const grid& mesh = run.mesh();
  thinned_mesh kept{mesh_axes(mesh), {}};
  for (auto& axis : kept.axes) {
    std::vector<double> centres;
    for (std::size_t i = 0; i < axis.centres.size(); i += static_cast<std::size_t>(stride))
      centres.push_back(axis.centres[i]);
    axis.centres = std::move(centres);
  }
  for (int cell = 0; cell < mesh.size(); ++cell) {
    bool keep = true;
    for (int k = 0; k < mesh.dimensions(); ++k)
      keep = keep && cell / mesh.stride(k) % mesh.cells(k) % stride == 0;
    if (keep) kept.cells.push_back(cell);
  }
  return kept;
}

std::vector<double> rows_of(const simulation& run, const std::vector<int>& cells) {
  std::vector<double> rows;
  rows.reserve(cells.size() * static_cast<std::size_t>(run.components()));
  for (const int cell : cells) {
    const auto row = run.row(cell);
    rows.insert(rows.end(), row.begin(), row.end());
  }
  return rows;
}

}  // namespace

distribution_at_points rows_at_points(const simulation& run, double unit_of_length) {
  distribution_at_points chosen;
  const auto& points = run.config().output.distribution_at;
  std::vector<int> cells;
  for (const auto& x : points) cells.push_back(cell_at(run.mesh(), x));
  chosen.f = rows_of(run, cells);
  for (int k = 0; k < run.mesh().dimensions() && !points.empty(); ++k) {
    mesh_axis& axis = chosen.centres.emplace_back();
    axis.name = "xyz"[k];
    for (const int cell : cells) axis.centres.push_back(run.mesh().centre(cell, k) * unit_of_length);
  }
  return chosen;
}

distribution_snapshot make_distribution_snapshot(const simulation& run) {
  const auto& output = run.config().output;
  distribution_snapshot now;
  now.t = run.t();
  now.step = run.step();
  now.components = static_cast<std::uint64_t>(run.components());
  now.velocities = run.velocities();
  if (output.distribution_at.empty()) {
    thinned_mesh kept = thinned(run, output.stride);
    now.axes = std::move(kept.axes);
    now.f = rows_of(run, kept.cells);
  } else {
    now.points = rows_at_points(run, 1.0);
  }
  return now;
}

}  // namespace apsis
