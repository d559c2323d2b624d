#include <apsis/output/solution.hpp>

#include <apsis/output/hdf5_file.hpp>

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

std::string data_item(const std::string& dimensions, const std::string& source) {
  return fmt::format(
      "<DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" "
      "Dimensions=\"{}\">solution.h5:/{}</DataItem>\n",
      dimensions, source);
}

std::string zero_axis() {
  return "<DataItem Format=\"XML\" Dimensions=\"1\">0</DataItem>\n";
}

std::string node_values(const std::string& name, const std::string& dimensions, const std::string& source) {
  return fmt::format("<Attribute Name=\"{}\" Center=\"Node\">{}</Attribute>\n", escaped(name),
                     data_item(dimensions, source));
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

}  // namespace

void write_solution(const std::string& path, const solution& s) {
  hdf5_file file = hdf5_file::create(path);
  file.write_attribute("title", s.title);
  file.write_attribute("t", s.t);
  file.write_attribute("step", static_cast<double>(s.step));
  file.write("f", s.f, {s.cells, s.components}, "unknowns");
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

std::string solution_xdmf(const solution& s) {
  std::string out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"2.2\">\n<Domain Name=\"{}\">\n",
      escaped(s.title));
  if (!s.fields.x.empty()) {
    const std::string cells = fmt::format("{}", s.cells);
    std::string values;
    for (const auto& name : s.fields.names) values += node_values(name, "1 1 " + cells, "fields/" + name);
    if (!s.epsilon.empty()) values += node_values("epsilon", "1 1 " + cells, "epsilon");
    out += grid("fields", 1, s.cells, data_item(cells, "x"), zero_axis(), s.t, values);
    if (s.velocities.size() == s.components && s.components > 1) {
      const std::string speeds = fmt::format("{}", s.components);
      out += grid("distribution", s.cells, s.components, data_item(speeds, "v"), data_item(cells, "x"), s.t,
                  node_values("f", fmt::format("1 {} {}", s.cells, s.components), "f"));
    }
  }
  return out + "</Domain>\n</Xdmf>\n";
}

}  // namespace apsis
