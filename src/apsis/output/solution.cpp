#include <apsis/output/solution.hpp>

#include <fmt/format.h>

namespace apsis {
namespace {

// In XML, five characters are markup; everything else of a title may stand.
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

/// Where numbers are: a dataset of a file beside the description.
std::string data_item(const std::string& dimensions, const std::string& source, int bytes = 8) {
  return fmt::format(
      "<DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"{}\" Dimensions=\"{}\">{}</DataItem>\n",
      bytes, dimensions, source);
}

/// Row k of a dataset [rows][columns].
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

// A grid with one axis of `fast` points (running fastest) and one of `slow` points.
std::string grid(const std::string& name, std::uint64_t slow, std::uint64_t fast,
                 const std::string& fast_axis, const std::string& slow_axis, double t,
                 const std::string& values) {
  return fmt::format(
      "<Grid Name=\"{}\" GridType=\"Uniform\">\n<Time Value=\"{:.17g}\"/>\n"
      "<Topology TopologyType=\"3DRectMesh\" Dimensions=\"1 {} {}\"/>\n<Geometry "
      "GeometryType=\"VXVYVZ\">\n{}{}{}</Geometry>\n{}</Grid>\n",
      name, t, slow, fast, fast_axis, slow_axis, zero_axis(), values);
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
    grids +=
        grid("fields", 1, s.cells, data_item(cells, "solution.h5:/x"), zero_axis(), snapshots[k].t, values);
  }
  return grids;
}

/// f over (v, x) as it stands in a file.
std::string grid_of_distribution(const std::string& file, std::uint64_t cells, std::uint64_t components,
                                 double t, precision stored = precision::float64) {
  return grid("distribution", cells, components, data_item(fmt::format("{}", components), file + ":/v"),
              data_item(fmt::format("{}", cells), file + ":/x"), t,
              node_values("f", data_item(fmt::format("1 {} {}", cells, components), file + ":/f",
                                         stored == precision::float64 ? 8 : 4)));
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
  if (!s.velocities.empty()) file.write("v", s.velocities, {s.velocities.size()}, "velocity");
  if (!s.fields.x.empty()) file.write("x", s.fields.x, {s.cells}, "cell centre");
  if (!s.epsilon.empty()) file.write("epsilon", s.epsilon, {s.epsilon.size()}, "Knudsen number");
  const auto& snapshots = s.fields.snapshots;
  for (std::size_t k = 0; k < s.fields.names.size() && !snapshots.empty(); ++k)
    file.write("fields/" + s.fields.names[k], snapshots.back().values[k], {s.cells}, s.fields.labels[k]);
  if (snapshots.size() > 1) {
    std::vector<double> times;
    for (const auto& snapshot : snapshots) times.push_back(snapshot.t);
    file.write("snapshots/t", times, {times.size()}, "time");
    for (std::size_t k = 0; k < s.fields.names.size(); ++k) {
      std::vector<double> all;
      for (const auto& snapshot : snapshots)
        all.insert(all.end(), snapshot.values[k].begin(), snapshot.values[k].end());
      file.write("snapshots/" + s.fields.names[k], all, {snapshots.size(), s.cells}, s.fields.labels[k]);
    }
  }
  file.close();
}

void write_distribution(const std::string& path, const distribution_snapshot& s, precision stored) {
  hdf5_file file = hdf5_file::create(path);
  file.write_attribute("t", s.t);
  file.write_attribute("step", static_cast<double>(s.step));
  file.write("f", s.f, {s.cells, s.components}, "unknowns", stored);
  if (!s.velocities.empty()) file.write("v", s.velocities, {s.velocities.size()}, "velocity");
  if (!s.x.empty()) file.write("x", s.x, {s.x.size()}, "cell centre");
  file.close();
}

std::string solution_xdmf(const solution& s, const std::vector<distribution_file>& distributions) {
  std::string out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"2.2\">\n<Domain Name=\"{}\">\n",
      escaped(s.title));
  if (!s.fields.x.empty()) {
    out += series_in_time("fields", grids_of_fields(s));
    std::string grids;
    for (const auto& one : distributions)
      if (one.has_axes) grids += grid_of_distribution(one.name, one.cells, one.components, one.t, one.stored);
    const bool has_axes = s.velocities.size() == s.components && s.components > 1;
    if (!s.f.empty() && has_axes && (distributions.empty() || distributions.back().t < s.t))
      grids += grid_of_distribution("solution.h5", s.cells, s.components, s.t);
    if (!grids.empty()) out += series_in_time("distribution", grids);
  }
  return out + "</Domain>\n</Xdmf>\n";
}

}  // namespace apsis
