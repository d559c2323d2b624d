#include <apsis/output/solution.hpp>

#include <apsis/output/velocity_axes.hpp>

namespace apsis {
namespace {

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

void write_marginals(hdf5_file& file, const std::vector<double>& f, std::uint64_t cells,
                     const velocity_set& velocities, precision stored) {
  for (const auto& one : marginals(f, cells, velocities))
    file.write("marginals/" + one.axis.name, one.values, {cells, one.axis.nodes.size()}, one.label, stored);
}

}  // namespace

void write_solution(const std::string& path, const solution& s) {
  hdf5_file file = hdf5_file::create(path);
  file.write_attribute("title", s.title);
  file.write_attribute("case", s.case_text);
  file.write_attribute("manifest", s.manifest);
  file.write_attribute("t", s.t);
  file.write_attribute("step", static_cast<double>(s.step));
  if (!s.f.empty()) file.write("f", s.f, {s.cells, s.components}, "unknowns");
  write_velocities(file, s.velocities);
  if (!s.f.empty()) write_marginals(file, s.f, s.cells, s.velocities, precision::float64);
  const field_series& fields = s.fields;
  constexpr auto doubles = precision::float64;
  if (!fields.x.empty()) file.write("x", fields.x, {s.cells}, "cell centre", doubles, fields.unit_of_x);
  if (!s.epsilon.empty()) file.write("epsilon", s.epsilon, {s.epsilon.size()}, "Knudsen number");
  const auto& snapshots = fields.snapshots;
  const auto unit = [&fields](std::size_t k) {
    return fields.units.empty() ? "dimensionless" : fields.units[k];
  };
  for (std::size_t k = 0; k < fields.names.size() && !snapshots.empty(); ++k)
    file.write("fields/" + fields.names[k], snapshots.back().values[k], {s.cells}, fields.labels[k], doubles,
               unit(k));
  if (snapshots.size() > 1) {
    std::vector<double> times;
    for (const auto& snapshot : snapshots) times.push_back(snapshot.t);
    file.write("snapshots/t", times, {times.size()}, "time", doubles, fields.unit_of_t);
    for (std::size_t k = 0; k < fields.names.size(); ++k) {
      std::vector<double> all;
      for (const auto& snapshot : snapshots)
        all.insert(all.end(), snapshot.values[k].begin(), snapshot.values[k].end());
      file.write("snapshots/" + fields.names[k], all, {snapshots.size(), s.cells}, fields.labels[k], doubles,
                 unit(k));
    }
  }
  file.close();
}

void write_distribution(const std::string& path, const distribution_snapshot& s, precision stored) {
  hdf5_file file = hdf5_file::create(path);
  file.write_attribute("t", s.t);
  file.write_attribute("step", static_cast<double>(s.step));
  file.write("f", s.f, {s.cells, s.components}, "unknowns", stored);
  write_velocities(file, s.velocities);
  write_marginals(file, s.f, s.cells, s.velocities, stored);
  if (!s.x.empty()) file.write("x", s.x, {s.x.size()}, "cell centre");
  file.close();
}

}  // namespace apsis
