#include <apsis/output/solution.hpp>
#include <apsis/output/velocity_axes.hpp>

#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace apsis {
namespace {

// Five characters are markup in XML; all others may appear in a title.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&apos;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 32 ? ' ' : c;
    }
  }
  return out;
}

/// Returns a reference to a dataset in a file beside the description.
std::string data_item(const std::string& dimensions, const std::string& source, int bytes = 8) {
  return fmt::format(
      "<DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"{}\" Dimensions=\"{}\">{}</DataItem>\n",
      bytes, dimensions, source);
}

/// Returns a reference to row k of a dataset [rows][columns].
std::string row_item(std::uint64_t k, std::uint64_t rows, std::uint64_t columns, const std::string& source) {
  return fmt::format(
      "<DataItem ItemType=\"HyperSlab\" Dimensions=\"1 1 {1}\">\n<DataItem Format=\"XML\" Dimensions=\"3 "
      "2\">{0} 0 1 "
      "1 1 {1}</DataItem>\n{2}</DataItem>\n",
      k, columns, data_item(fmt::format("{} {}", rows, columns), source));
}

std::string zero_axis() {
  return "<DataItem Format=\"XML\" Dimensions=\"1\">0</DataItem>\n";
}

std::string node_values(const std::string& name, const std::string& item) {
  return fmt::format("<Attribute Name=\"{}\" Center=\"Node\">{}</Attribute>\n", escaped(name), item);
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

std::string series_in_time(const std::string& name, const std::string& grids) {
  return fmt::format("<Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n{}</Grid>\n",
                     name, grids);
}

std::string grids_of_fields(const solution& s) {
  const std::string cells = fmt::format("{}", s.cells), along = "1 1 " + cells;
  const auto& snapshots = s.fields.snapshots;
  std::string grids;
  for (std::size_t k = 0; k < snapshots.size(); ++k) {
    std::string values;
    for (const auto& name : s.fields.names)
      values += node_values(name, snapshots.size() > 1 ? row_item(k, snapshots.size(), s.cells,
                                                                  "solution.h5:/snapshots/" + name)
                                                       : data_item(along, "solution.h5:/fields/" + name));
    if (!s.epsilon.empty()) values += node_values("epsilon", data_item(along, "solution.h5:/epsilon"));
    grids += grid("fields", {axis_of(s.cells, "solution.h5:/x")}, snapshots[k].t, values);
  }
  return grids;
}

/// Returns a grid of values [cells][…] over x and the velocity axes, slowest axis first.
std::string grid_in_phase_space(const std::string& name, const distribution_file& file,
                                const std::vector<velocity_axis>& axes, const std::string& dataset,
                                const std::string& attribute) {
  std::array<grid_axis, 3> all;
  for (std::size_t k = 0; k < axes.size(); ++k)
    all[axes.size() - 1 - k] = axis_of(axes[k].nodes.size(), file.name + ":/" + axes[k].name);
  all[axes.size()] = axis_of(file.cells, file.name + ":/x");
  const int bytes = file.stored == precision::float64 ? 8 : 4;
  return grid(name, all, file.t,
              node_values(attribute, data_item(points_of(all), file.name + ":/" + dataset, bytes)));
}

/// Returns the time series of f and its marginals.
std::string series_of_distributions(const std::vector<distribution_file>& files, const velocity_set& set) {
  const auto axes = velocity_axes(set);
  if (axes.empty() || set.sets() > 1)
    return "<!-- f is omitted: it is not a single function on a tensor product of velocities. -->\n";
  std::string out, grids;
  if (axes.size() > 2)
    out += "<!-- f has the four axes x, v_x, v_y, v_z, too many for a grid: its marginals follow. -->\n";
  if (axes.size() == 2) out += "<!-- The axes X, Y, Z of the grids of f are v_y, v_x, x. -->\n";
  for (const auto& file : files)
    if (axes.size() <= 2) grids += grid_in_phase_space("distribution", file, axes, "f", "f");
  if (!grids.empty()) out += series_in_time("distribution", grids);
  for (std::size_t k = 0; k < axes.size() && axes.size() > 1; ++k) {
    const std::string name = "marginal_" + axes[k].name;
    grids.clear();
    for (const auto& file : files)
      grids += grid_in_phase_space(name, file, {axes[k]}, "marginals/" + axes[k].name, name);
    out += series_in_time(name, grids);
  }
  return out;
}

}  // namespace

std::string solution_xdmf(const solution& s, const std::vector<distribution_file>& distributions) {
  std::string out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"2.2\">\n<Domain Name=\"{}\">\n",
      escaped(s.title));
  if (!s.fields.x.empty()) {
    out += series_in_time("fields", grids_of_fields(s));
    std::vector<distribution_file> files;
    for (const auto& one : distributions)
      if (one.has_axes) files.push_back(one);
    const bool has_axes = s.velocities.components() > 1;
    if (!s.f.empty() && has_axes && (distributions.empty() || distributions.back().t < s.t))
      files.push_back({"solution.h5", s.t, s.cells, s.components, true});
    if (!files.empty()) out += series_of_distributions(files, s.velocities);
  }
  return out + "</Domain>\n</Xdmf>\n";
}

}  // namespace apsis
