#include <apsis/output/solution.hpp>

#include <apsis/output/velocity_axes.hpp>

#include <algorithm>

namespace apsis {
namespace {

using shape = hdf5_file::shape;

/// Returns the extents of `last` numbers in every cell.
shape with(shape cells, std::uint64_t last) {
  cells.push_back(last);
  return cells;
}

void write_velocities(hdf5_file& file, const velocity_set& velocities) {
  const auto points = static_cast<std::uint64_t>(velocities.size());
  const auto dimensions = static_cast<std::uint64_t>(velocities.dimensions());
  if (dimensions == 0) return;
  if (dimensions == 1) return file.write("v", velocity_points(velocities), {points}, "velocity");
  file.write("v", velocity_points(velocities), {points, dimensions}, "velocity");
  const auto weights = velocities.weights();
  file.write("v_weights", {weights.begin(), weights.end()}, {points}, "quadrature weight");
  for (const auto& axis : velocity_axes(velocities))
    file.write(axis.name, axis.nodes, {axis.nodes.size()}, "velocity component");
}

/// Returns the part of a dataset that has `last` numbers in every cell of a part of the mesh.
dataset_part with(dataset_part part, std::uint64_t last) {
  part.first.push_back(0);
  part.count.push_back(last);
  return part;
}

/// Writes `last` numbers for every cell of the axes, or of the part of this process.
void write_cells(hdf5_file& file, const std::string& name, const std::vector<double>& values,
                 const std::vector<mesh_axis>& axes, const std::optional<dataset_part>& part,
                 std::uint64_t last, const std::string& label, precision stored) {
  const shape all = with(mesh_shape(axes), last);
  if (part)
    file.write_part(name, values, all, with(*part, last), label, stored);
  else
    file.write(name, values, all, label, stored);
}

void write_f(hdf5_file& file, const std::vector<double>& f, const std::vector<mesh_axis>& axes,
             const std::optional<dataset_part>& part, std::uint64_t components, precision stored) {
  if (f.empty() && !part) return;
  write_cells(file, "f", f, axes, part, components, "unknowns", stored);
}

void write_marginals(hdf5_file& file, const std::vector<double>& f, const std::vector<mesh_axis>& axes,
                     const std::optional<dataset_part>& part, const velocity_set& velocities,
                     precision stored) {
  if (f.empty() && !part) return;
  const std::uint64_t cells = f.size() / static_cast<std::uint64_t>(std::max(velocities.components(), 1));
  for (const auto& one : marginals(f, cells, velocities))
    write_cells(file, "marginals/" + one.axis.name, one.values, axes, part, one.axis.nodes.size(), one.label,
                stored);
}

void write_coordinates(hdf5_file& file, const std::string& group, const std::vector<mesh_axis>& axes,
                       const std::string& unit) {
  for (const auto& axis : axes)
    file.write(group + axis.name, axis.centres, {axis.centres.size()}, "cell centre", precision::float64,
               unit);
}

void write_points(hdf5_file& file, const distribution_at_points& points, std::uint64_t components,
                  precision stored, const std::string& unit) {
  if (points.centres.empty()) return;
  file.write("points/f", points.f, {points.centres.front().centres.size(), components}, "unknowns", stored);
  write_coordinates(file, "points/", points.centres, unit);
}

/// Writes the points of a structured grid. Readers take the first axis of a rectilinear grid for the fastest.
void write_geometry(hdf5_file& file, const field_series& fields) {
  if (fields.axes.size() < 2) return;
  std::vector<double> points;
  for (std::size_t cell = 0; cell < mesh_size(fields.axes) && file.writes_frame(); ++cell)
    for (std::size_t k = 0; k < 3; ++k)
      points.push_back(k < fields.axes.size() ? centre_of_cell(fields.axes, cell, k) : 0.0);
  file.write("geometry/centres", points, with(mesh_shape(fields.axes), 3), "cell centre", precision::float64,
             fields.unit_of_x);
}

void write_series(hdf5_file& file, const field_series& fields) {
  const auto cells = mesh_shape(fields.axes);
  const auto& snapshots = fields.snapshots;
  constexpr auto doubles = precision::float64;
  const auto unit = [&fields](std::size_t k) {
    return fields.units.empty() ? "dimensionless" : fields.units[k];
  };
  for (std::size_t k = 0; k < fields.names.size() && !snapshots.empty(); ++k)
    file.write("fields/" + fields.names[k], snapshots.back().values[k], cells, fields.labels[k], doubles,
               unit(k));
  if (snapshots.size() < 2) return;
  std::vector<double> times;
  for (const auto& snapshot : snapshots) times.push_back(snapshot.t);
  file.write("snapshots/t", times, {times.size()}, "time", doubles, fields.unit_of_t);
  shape of_all = {snapshots.size()};
  of_all.insert(of_all.end(), cells.begin(), cells.end());
  for (std::size_t k = 0; k < fields.names.size(); ++k) {
    std::vector<double> all;
    for (const auto& snapshot : snapshots)
      all.insert(all.end(), snapshot.values[k].begin(), snapshot.values[k].end());
    file.write("snapshots/" + fields.names[k], all, of_all, fields.labels[k], doubles, unit(k));
  }
}

void write_walls(hdf5_file& file, const solution& s) {
  for (const wall_outline& one : s.walls) {
    const auto size = one.shape();
    file.write("walls/" + one.name, one.array(), {size.begin(), size.end()},
               one.dimensions == 2 ? "ends of the pieces of a wall" : "corners of the pieces of a wall",
               precision::float64, s.fields.unit_of_x);
  }
}

void write_contents(hdf5_file& file, const solution& s) {
  file.write_attribute("title", s.title);
  file.write_attribute("case", s.case_text);
  file.write_attribute("manifest", s.manifest);
  file.write_attribute("t", s.t);
  file.write_attribute("step", static_cast<double>(s.step));
  const auto& axes = s.fields.axes;
  write_f(file, s.f, axes, s.part, s.components, precision::float64);
  write_points(file, s.points, s.components, precision::float64, s.fields.unit_of_x);
  write_velocities(file, s.velocities);
  write_marginals(file, s.f, axes, s.part, s.velocities, precision::float64);
  write_coordinates(file, "", axes, s.fields.unit_of_x);
  if (!s.epsilon.empty()) file.write("epsilon", s.epsilon, mesh_shape(axes), "Knudsen number");
  write_geometry(file, s.fields);
  write_walls(file, s);
  write_series(file, s.fields);
}

void write_contents(hdf5_file& file, const distribution_snapshot& s, precision stored) {
  file.write_attribute("t", s.t);
  file.write_attribute("step", static_cast<double>(s.step));
  write_f(file, s.f, s.axes, s.part, s.components, stored);
  write_points(file, s.points, s.components, stored, "dimensionless");
  write_velocities(file, s.velocities);
  if (s.f.empty() && !s.part) return;
  write_marginals(file, s.f, s.axes, s.part, s.velocities, stored);
  write_coordinates(file, "", s.axes, "dimensionless");
}

}  // namespace

std::array<std::size_t, 3> wall_outline::shape() const {
  std::size_t most = 2;
  for (const auto& piece : corners) most = std::max(most, piece.size());
  return {corners.size(), most, static_cast<std::size_t>(dimensions)};
}

std::vector<double> wall_outline::array() const {
  const std::size_t most = shape()[1];
  std::vector<double> all;
  all.reserve(corners.size() * most * static_cast<std::size_t>(dimensions));
  for (const auto& piece : corners)
    for (std::size_t k = 0; k < most; ++k) {
      const position& corner = piece[std::min(k, piece.size() - 1)];
      all.insert(all.end(), corner.begin(), corner.begin() + dimensions);
    }
  return all;
}

void write_solution(const std::string& path, const solution& s,
                    const std::shared_ptr<communicator>& processes) {
  write_hdf5(path, 0, processes, [&s](hdf5_file& file) { write_contents(file, s); });
}

void write_fields(const std::string& path, const std::string& title, const field_series& fields) {
  hdf5_file file = hdf5_file::create(path);
  file.write_attribute("title", title);
  write_coordinates(file, "", fields.axes, fields.unit_of_x);
  write_geometry(file, fields);
  write_series(file, fields);
  file.close();
}

void write_distribution(const std::string& path, const distribution_snapshot& s, precision stored,
                        const std::shared_ptr<communicator>& processes) {
  write_hdf5(path, 0, processes, [&](hdf5_file& file) { write_contents(file, s, stored); });
}

}  // namespace apsis
