#include <apsis/output/mesh_xdmf.hpp>

#include <apsis/output/xdmf_text.hpp>

#include <algorithm>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis::xdmf {
namespace {

const std::vector<std::string> of_vector = {"_x", "_y", "_z"};
const std::vector<std::string> of_tensor = {"_xx", "_xy", "_xz", "_xy", "_yy", "_yz", "_xz", "_yz", "_zz"};

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Returns the names without `ending` for which all other endings are fields too.
std::vector<std::string> heads(const std::vector<std::string>& names, const std::string& ending,
                               const std::vector<std::string>& others) {
  std::vector<std::string> found;
  for (const auto& name : names) {
    if (!name.ends_with(ending)) continue;
    const std::string head = name.substr(0, name.size() - ending.size());
    if (std::all_of(others.begin(), others.end(),
                    [&](const auto& other) { return contains(names, head + other); }))
      found.push_back(head);
  }
  return found;
}

/// Returns an attribute joined from components. `item` refers to a field, `zero` to as many zeros.
std::string joined_values(const std::string& name, const std::string& type, const std::string& dimensions,
                          const std::vector<std::string>& endings, const std::vector<std::string>& fields,
                          const std::function<std::string(const std::string&)>& item,
                          const std::string& zero) {
  std::vector<std::string> used, arguments;
  std::string items;
  for (const auto& ending : endings) {
    const bool known = contains(fields, name + ending);
    const std::string source = known ? name + ending : "";
    const auto at = std::find(used.begin(), used.end(), source);
    arguments.push_back(fmt::format("${}", at - used.begin()));
    if (at != used.end()) continue;
    used.push_back(source);
    items += known ? item(source) : zero;
  }
  return fmt::format(
      "<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">\n<DataItem ItemType=\"Function\" "
      "Function=\"JOIN({})\" Dimensions=\"{} {}\">\n{}</DataItem>\n</Attribute>\n",
      escaped(name), type, fmt::join(arguments, ", "), dimensions, endings.size(), items);
}

/// Returns a reference to the third coordinate of a plane, which is zero.
std::string third_coordinate(const std::string& dimensions, const std::vector<std::uint64_t>& shape,
                             const std::string& file) {
  return fmt::format(
      "<DataItem ItemType=\"HyperSlab\" Dimensions=\"{}\">\n<DataItem Format=\"XML\" Dimensions=\"3 3\">"
      "0 0 2 1 1 1 {} 1</DataItem>\n{}</DataItem>\n",
      dimensions, joined(shape), data_item(joined(shape) + " 3", file + ":/geometry/centres"));
}

}  // namespace

std::string grids_on_mesh(const field_series& fields, const std::string& file, bool epsilon) {
  const auto shape = mesh_shape(fields.axes);
  const std::size_t count = fields.snapshots.size();
  const bool plane = shape.size() == 2;
  const std::string dimensions = joined(shape) + (plane ? " 1" : "");
  const std::string zero = plane ? third_coordinate(dimensions, shape, file) : "";
  std::vector<std::string> others = {"_y"}, pairs = {"_xy", "_yy"};
  if (!plane) {
    others = of_vector;
    pairs = of_tensor;
  }
  std::string grids;
  for (std::size_t k = 0; k < count; ++k) {
    const auto item = [&](const std::string& name) {
      return count > 1 ? part_item(dimensions, k, count, shape, fmt::format("{}:/snapshots/{}", file, name))
                       : data_item(dimensions, fmt::format("{}:/fields/{}", file, name));
    };
    std::string values;
    for (const auto& name : fields.names) values += node_values(name, item(name));
    for (const auto& name : heads(fields.names, "_x", others))
      values += joined_values(name, "Vector", dimensions, of_vector, fields.names, item, zero);
    for (const auto& name : heads(fields.names, "_xx", pairs))
      values += joined_values(name, "Tensor", dimensions, of_tensor, fields.names, item, zero);
    if (epsilon) values += node_values("epsilon", data_item(dimensions, file + ":/epsilon"));
    grids += fmt::format(
        "<Grid Name=\"fields\" GridType=\"Uniform\">\n<Time Value=\"{:.17g}\"/>\n"
        "<Topology TopologyType=\"3DSMesh\" Dimensions=\"{}\"/>\n<Geometry GeometryType=\"XYZ\">\n{}"
        "</Geometry>\n{}</Grid>\n",
        fields.snapshots[k].t, dimensions, data_item(dimensions + " 3", file + ":/geometry/centres"), values);
  }
  return grids;
}

}  // namespace apsis::xdmf
