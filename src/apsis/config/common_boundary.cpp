#include <apsis/config/common_boundary.hpp>

#include <apsis/config/case_value.hpp>
#include <apsis/mesh/face.hpp>

#include <algorithm>
#include <cstddef>
#include <map>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

const std::string head_of_faces = "boundary.";
const std::string head_of_all = head_of_faces + every_face + ".";

/// Returns whether a sorted set or map of paths contains a key, or keys of its table.
template <class Paths>
bool has_key(const Paths& paths, const std::string& key) {
  if (paths.contains(key)) return true;
  const auto below = paths.lower_bound(key + ".");
  if (below == paths.end()) return false;
  if constexpr (requires { below->first; })
    return below->first.starts_with(key + ".");
  else
    return below->starts_with(key + ".");
}

/// Returns whether the paths contain a variable of a face. A profile gives rho, u and T.
template <class Paths>
bool has_variable(const Paths& paths, const std::string& face_name, const std::string& variable) {
  const std::string table = head_of_faces + face_name + ".";
  const bool in_profile = variable == "rho" || variable == "u" || variable == "T";
  return has_key(paths, table + variable) || (in_profile && has_key(paths, table + "profile"));
}

/// Returns "T" for "T" and "T.file".
std::string variable_in(const std::string& keys) {
  return keys.substr(0, keys.find('.'));
}

/// Returns the names of the faces of the case.
std::vector<std::string> faces_of(const case_text& text) {
  const raw_value* cells = text.find("space.cells");
  const auto* list = cells == nullptr ? nullptr : std::get_if<raw_value::list>(&cells->value);
  const std::size_t count = std::min(face_names.size(), 2 * (list == nullptr ? 1 : list->size()));
  return {face_names.begin(), face_names.begin() + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

void expand_common_boundary(case_text& text) {
  const std::string kind = head_of_all + "kind";
  if (const raw_value* raw = text.find(kind); raw != nullptr && text.find("space.boundary") != nullptr)
    throw input_error(raw->place, fmt::format("'{}' conflicts with 'space.boundary' (both give the kind of "
                                              "all faces); remove one of them",
                                              kind));
  std::map<std::string, raw_value> made;
  std::vector<std::string> expanded;
  for (const auto& [path, raw] : text.values) {
    if (!path.starts_with(head_of_all) || path == kind) continue;
    const std::string keys = path.substr(head_of_all.size());
    expanded.push_back(path);
    bool used = false;
    for (const std::string& name : faces_of(text)) {
      const bool own_kind = text.find(head_of_faces + name + ".kind") != nullptr;
      if (own_kind || has_variable(text.values, name, variable_in(keys))) continue;
      made.emplace(fmt::format("{}{}.{}", head_of_faces, name, keys), raw);
      used = true;
    }
    if (!used)
      throw input_error(raw.place, fmt::format("key '{}' is not used (every face has its own kind or value); "
                                               "remove it",
                                               shown(path)));
  }
  for (const std::string& path : expanded) text.values.erase(path);
  text.values.merge(made);
}

bool is_common_boundary(const case_config& config, const std::string& path) {
  if (!path.starts_with(head_of_faces)) return false;
  const auto dot = path.find('.', head_of_faces.size());
  if (dot == std::string::npos) return false;
  const std::string name = path.substr(head_of_faces.size(), dot - head_of_faces.size());
  const std::string variable = variable_in(path.substr(dot + 1));
  return !has_variable(config.given, name, variable) && has_variable(config.given, every_face, variable);
}

std::string given_boundary_path(const case_config& config, const std::string& path) {
  if (!is_common_boundary(config, path)) return path;
  return head_of_all + path.substr(path.find('.', head_of_faces.size()) + 1);
}

void erase_common_boundary(case_text& text, const case_config& config, const std::string& face_name) {
  const std::string table = head_of_faces + face_name + ".";
  std::erase_if(text.values, [&](const auto& one) {
    return one.first.starts_with(table) && is_common_boundary(config, one.first);
  });
}

}  // namespace apsis
