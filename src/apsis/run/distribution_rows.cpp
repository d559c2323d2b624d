#include <apsis/run/distribution_rows.hpp>

#include <apsis/core/index.hpp>
#include <apsis/mesh/cell_at.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace apsis {
namespace {

/// Every stride-th cell of the mesh in each direction, and the kept cells in the block of this process.
struct thinned_mesh {
  std::vector<mesh_axis> axes;
  std::vector<int> cells;  ///< indices of the kept cells in the block
  dataset_part part;       ///< position of the block among all kept cells
};

thinned_mesh thinned(const simulation& run, int stride) {
  if (!run.setup().has_space()) return {{}, {0}, {}};
  const grid& mesh = run.mesh();
  thinned_mesh kept{mesh_axes(mesh), {}, {}};
  for (auto& axis : kept.axes) {
    std::vector<double> centres;
    for (std::size_t i = 0; i < axis.centres.size(); i += at(stride)) centres.push_back(axis.centres[i]);
    axis.centres = std::move(centres);
  }
  const grid& block = run.setup().mesh();
  const auto kept_before = [&](int cell) { return static_cast<std::uint64_t>((cell + stride - 1) / stride); };
  for (int k = 0; k < block.dimensions(); ++k) {
    kept.part.first.push_back(kept_before(block.first(k)));
    kept.part.count.push_back(kept_before(block.first(k) + block.cells(k)) - kept.part.first.back());
  }
  for (int cell = 0; cell < block.size(); ++cell) {
    bool keep = true;
    for (int k = 0; k < block.dimensions(); ++k)
      keep = keep && (block.first(k) + cell / block.stride(k) % block.cells(k)) % stride == 0;
    if (keep) kept.cells.push_back(cell);
  }
  return kept;
}

std::vector<double> rows_of(const simulation& run, const std::vector<int>& cells) {
  std::vector<double> rows;
  rows.reserve(cells.size() * at(run.setup().equation->components()));
  for (const int cell : cells) {
    const auto row = run.densities_in(cell);
    rows.insert(rows.end(), row.begin(), row.end());
  }
  return rows;
}

/// Returns the index within the block of a cell of the mesh; −1 if another process owns the cell.
int own_cell(const simulation& run, int cell) {
  const grid &mesh = run.mesh(), &block = run.setup().mesh();
  int number = 0;
  for (int k = 0; k < 3; ++k) {
    const int along = cell / mesh.stride(k) % mesh.cells(k) - block.first(k);
    if (along < 0 || along >= block.cells(k)) return -1;
    number += along * block.stride(k);
  }
  return number;
}

/// Returns the rows of the given cells of the mesh in their order, on the root.
std::vector<double> gathered_rows(const simulation& run, const std::vector<int>& cells) {
  std::vector<double> mine;  // for each own cell its index in `cells`, then its row
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const int own = run.setup().has_space() ? own_cell(run, cells[k]) : 0;
    if (own < 0) continue;
    mine.push_back(static_cast<double>(k));
    const auto row = run.densities_in(own);
    mine.insert(mine.end(), row.begin(), row.end());
  }
  const std::vector<double> all = gather_numbers(run.processes(), mine);
  std::vector<double> rows(run.processes().is_root() ? cells.size() * at(run.setup().equation->components())
                                                     : 0);
  for (std::size_t from = 0; from < all.size(); from += 1 + at(run.setup().equation->components()))
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(from) + 1, run.setup().equation->components(),
                rows.begin() + static_cast<std::ptrdiff_t>(all[from]) * run.setup().equation->components());
  return rows;
}

}  // namespace

std::optional<dataset_part> part_of(const simulation& run) {
  if (run.processes().is_single()) return std::nullopt;
  return part_of(run.setup().mesh());
}

dataset_part part_of(const grid& block) {
  dataset_part part;
  for (int k = 0; k < block.dimensions(); ++k) {
    part.first.push_back(static_cast<std::uint64_t>(block.first(k)));
    part.count.push_back(static_cast<std::uint64_t>(block.cells(k)));
  }
  return part;
}

distribution_at_points rows_at_points(const simulation& run, double unit_of_length) {
  distribution_at_points chosen;
  const auto& points = run.config().output.distribution_at;
  std::vector<int> cells;
  for (const auto& x : points) cells.push_back(cell_at(run.mesh(), x));
  chosen.f = gathered_rows(run, cells);
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
  now.components = static_cast<std::uint64_t>(run.setup().equation->components());
  now.velocities = run.setup().equation->velocities();
  if (output.distribution_at.empty()) {
    thinned_mesh kept = thinned(run, output.stride);
    now.axes = std::move(kept.axes);
    now.f = rows_of(run, kept.cells);
    if (!run.processes().is_single()) now.part = std::move(kept.part);
  } else {
    now.points = rows_at_points(run, 1.0);
  }
  return now;
}

}  // namespace apsis
