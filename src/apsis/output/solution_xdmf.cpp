#include <apsis/output/mesh_xdmf.hpp>
#include <apsis/output/solution.hpp>
#include <apsis/output/velocity_axes.hpp>
#include <apsis/output/xdmf_text.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace apsis {
namespace {

using namespace xdmf;

std::string zero_axis() {
  return "<DataItem Format=\"XML\" Dimensions=\"1\">0</DataItem>\n";
}

/// One axis of a grid: number of points and reference to their coordinates.
struct grid_axis {
  std::uint64_t points = 1;
  std::string coordinates = zero_axis();
};

grid_axis axis_of(std::uint64_t points, const std::string& source) {
  return {points, data_item(fmt::format("{}", points), source)};
}

/// Returns the numbers of points of the three axes, slowest axis first.
std::string points_of(const std::array<grid_axis, 3>& axes) {
  return fmt::format("{} {} {}", axes[2].points, axes[1].points, axes[0].points);
}

/// Returns a rectilinear grid; axes[0] is the fastest axis.
std::string grid(const std::string& name, const std::array<grid_axis, 3>& axes, double t,
                 const std::string& values) {
  return fmt::format(
      "<Grid Name=\"{}\" GridType=\"Uniform\">\n<Time Value=\"{:.17g}\"/>\n"
      "<Topology TopologyType=\"3DRectMesh\" Dimensions=\"{}\"/>\n<Geometry "
      "GeometryType=\"VXVYVZ\">\n{}{}{}</Geometry>\n{}</Grid>\n",
      name, t, points_of(axes), axes[0].coordinates, axes[1].coordinates, axes[2].coordinates, values);
}

std::string grids_of_fields(const solution& s) {
  const auto shape = mesh_shape(s.fields.axes);
  const std::string along = "1 1 " + joined(shape);
  const auto& snapshots = s.fields.snapshots;
  std::string grids;
  for (std::size_t k = 0; k < snapshots.size(); ++k) {
    std::string values;
    for (const auto& name : s.fields.names)
      values += node_values(name, snapshots.size() > 1 ? part_item(along, k, snapshots.size(), shape,
                                                                   "solution.h5:/snapshots/" + name)
                                                       : data_item(along, "solution.h5:/fields/" + name));
    if (!s.epsilon.empty()) values += node_values("epsilon", data_item(along, "solution.h5:/epsilon"));
    grids += grid("fields", {axis_of(shape.front(), "solution.h5:/x")}, snapshots[k].t, values);
  }
  return grids;
}

/// Returns the axes of a function of position and velocity, slowest first.
std::vector<grid_axis> axes_of(const distribution_file& file, const std::vector<velocity_axis>& velocities) {
  std::vector<grid_axis> axes;
  for (std::size_t k = 0; k < file.shape.size(); ++k)
    axes.push_back(axis_of(file.shape[k], file.name + ":/" + "xyz"[k]));
  for (const auto& axis : velocities)
    axes.push_back(axis_of(axis.nodes.size(), file.name + ":/" + axis.name));
  return axes;
}

/// Returns a grid over at most three axes, slowest first.
std::string grid_in_phase_space(const std::string& name, const distribution_file& file,
                                const std::vector<grid_axis>& axes, const std::string& dataset,
                                const std::string& attribute) {
  std::array<grid_axis, 3> all;
  std::copy(axes.rbegin(), axes.rend(), all.begin());
  const int bytes = file.stored == precision::float64 ? 8 : 4;
  return grid(name, all, file.t,
              node_values(attribute, data_item(points_of(all), file.name + ":/" + dataset, bytes)));
}

std::string too_many_axes(const std::string& what, std::size_t axes, const std::string& instead) {
  return fmt::format("<!-- {} {} axes, too many for a grid{}. -->\n", what, axes, instead);
}

/// Returns the time series of f and its marginals over `dimensions` axes of space.
std::string series_of_distributions(const std::vector<distribution_file>& files, const velocity_set& set,
                                    std::size_t dimensions) {
  const auto axes = velocity_axes(set);
  if (axes.empty() || set.sets() > 1)
    return "<!-- f is omitted: it is not a single function on a tensor product of velocities. -->\n";
  std::string out, grids;
  const bool whole = dimensions + axes.size() <= 3, marginal = axes.size() > 1 && dimensions <= 2;
  if (dimensions == 1 && axes.size() > 2)
    out += "<!-- f has the four axes x, v_x, v_y, v_z, too many for a grid: its marginals follow. -->\n";
  else if (!whole)
    out += too_many_axes("f has", dimensions + axes.size(), marginal ? ": its marginals follow" : "");
  if (dimensions == 1 && axes.size() == 2)
    out += "<!-- The axes X, Y, Z of the grids of f are v_y, v_x, x. -->\n";
  if (dimensions == 2) out += "<!-- The axes X, Y, Z of the grids of f and its marginals are v, y, x. -->\n";
  for (const auto& file : files)
    if (whole) grids += grid_in_phase_space("distribution", file, axes_of(file, axes), "f", "f");
  if (!grids.empty()) out += series_in_time("distribution", grids);
  for (std::size_t k = 0; k < axes.size() && marginal; ++k) {
    const std::string name = "marginal_" + axes[k].name;
    grids.clear();
    for (const auto& file : files)
      grids += grid_in_phase_space(name, file, axes_of(file, {axes[k]}), "marginals/" + axes[k].name, name);
    out += series_in_time(name, grids);
  }
  return out;
}

}  // namespace

std::string solution_xdmf(const solution& s, const std::vector<distribution_file>& distributions) {
  std::string out;
  const auto& axes = s.fields.axes;
  if (!axes.empty()) {
    out += series_in_time("fields", axes.size() == 1
                                        ? grids_of_fields(s)
                                        : grids_on_mesh(s.fields, "solution.h5", !s.epsilon.empty()));
    std::vector<distribution_file> files = distributions;
    const bool has_axes = s.velocities.components() > 1;
    if (!s.f.empty() && has_axes && (distributions.empty() || distributions.back().t < s.t))
      files.push_back({"solution.h5", s.t, mesh_shape(axes)});
    if (!files.empty()) out += series_of_distributions(files, s.velocities, axes.size());
  }
  return document(s.title, out);
}

std::string fields_xdmf(const std::string& title, const field_series& fields, const std::string& file) {
  return document(title, series_in_time("fields", grids_on_mesh(fields, file, false)));
}

}  // namespace apsis
