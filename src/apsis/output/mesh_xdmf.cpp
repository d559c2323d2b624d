#include <apsis/output/mesh_xdmf.hpp>

#include <apsis/output/xdmf_text.hpp>

#include <algorithm>
#include <array>
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

/// Returns the names without `ending` for which all other endings of the plane are fields too.
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

/// Returns an attribute joined from components; those that are not fields are zero.
std::string joined_values(const std::string& name, const std::string& type, const std::string& dimensions,
                          const std::vector<std::string>& endings, const std::vector<std::string>& fields,
                          const std::function<std::string(const std::string&)>& item) {
  std::vector<std::string> used, arguments;
  std::string items;
  for (const auto& ending : endings) {
    const std::string component = name + ending;
    const bool known = contains(fields, component);
    const std::string source = known ? component : name + endings.front();
    auto at = std::find(used.begin(), used.end(), source);
    if (at == used.end()) {
      items += item(source);
      at = used.insert(used.end(), source);
    }
    arguments.push_back(fmt::format("{}${}", known ? "" : "0 * ", at - used.begin()));
  }
  return fmt::format(
      "<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">\n<DataItem ItemType=\"Function\" "
      "Function=\"JOIN({})\" Dimensions=\"{} {}\">\n{}</DataItem>\n</Attribute>\n",
      escaped(name), type, fmt::join(arguments, ", "), dimensions, endings.size(), items);
}

}  // namespace

std::string grids_on_mesh(const field_series& fields, const std::string& file, bool epsilon) {
  const auto shape = mesh_shape(fields.axes);
  const std::size_t count = fields.snapshots.size();
  const std::string dimensions = joined(shape) + (shape.size() == 2 ? " 1" : "");
  std::string grids;
  for (std::size_t k = 0; k < count; ++k) {
    const auto item = [&](const std::string& name) {
      return count > 1 ? part_item(dimensions, k, count, shape, file + ":/snapshots/" + name)
                       : data_item(dimensions, file + ":/fields/" + name);
    };
    std::string values;
    for (const auto& name : fields.names) values += node_values(name, item(name));
    for (const auto& name : heads(fields.names, "_x", {"_y"}))
      values += joined_values(name, "Vector", dimensions, of_vector, fields.names, item);
    for (const auto& name : heads(fields.names, "_xx", {"_xy", "_yy"}))
      values += joined_values(name, "Tensor", dimensions, of_tensor, fields.names, item);
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
