#include <apsis/config/profile_reader.hpp>

#include <apsis/config/at_place.hpp>
#include <apsis/config/case_json.hpp>
#include <apsis/config/case_units.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/core/index.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/mesh/face.hpp>
#include <apsis/model/formula_table.hpp>
#include <apsis/output/hdf5_file.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace apsis {
namespace {

const std::string profile_key = ".profile.file";
/// Five variables of so many cells fit into longest_case_file bytes. Longer cases could not be continued.
constexpr std::size_t most_cells = 8000;

/// A side of an earlier result.
class earlier_side {
 public:
  earlier_side(const std::string& path, const face& where, const std::optional<gas_scales>& scales)
      : file_(hdf5_file::open(path)), where_(where), scales_(scales) {
    if (!file_.has_attribute("manifest") || !file_.has("fields/rho") || !file_.has("fields/T"))
      throw input_error("it is no result of a gas (rho and T are needed); give a solution.h5");
    shape_ = file_.extents("fields/rho");
    check_scales();
    if (static_cast<std::size_t>(where.direction) >= shape_.size())
      throw input_error(fmt::format(
          "it has no such side (it has {} space dimension{}); give {}", shape_.size(),
          shape_.size() == 1 ? "" : "s",
          fmt::join(face_names.begin(), face_names.begin() + 2 * static_cast<std::ptrdiff_t>(shape_.size()),
                    shape_.size() == 1 ? " or " : ", ")));
  }

  std::size_t dimensions() const { return shape_.size(); }

  /// Returns rho, u and T as formulas.
  std::map<std::string, std::vector<std::string>> formulas() const {
    std::map<std::string, std::vector<std::string>> all;
    all["rho"] = {formula("rho", dimensions::density)};
    all["T"] = {formula("T", dimensions::temperature)};
    if (file_.has("fields/u")) all["u"] = {formula("u", dimensions::velocity)};
    for (const char axis : {'x', 'y', 'z'})
      if (const std::string name = fmt::format("u_{}", axis); file_.has("fields/" + name))
        all["u"].push_back(formula(name, dimensions::velocity));
    return all;
  }

 private:
  /// Checks that dimensionless numbers of the result have the scales of the case.
  void check_scales() const {
    const auto manifest =
        nlohmann::ordered_json::parse(file_.read_text_attribute("manifest"), nullptr, false);
    const auto theirs =
        manifest.is_object() && manifest.contains("scales") ? manifest["scales"] : nlohmann::ordered_json();
    const bool has_units = file_.units("fields/rho") != unit_of(dimensions::none);
    if (has_units || theirs.is_null()) return;
    if (!scales_ || theirs != to_json(*scales_))
      throw input_error(
          "its units are those of another table [gas] (the scales differ); write it with output.units = "
          "\"SI\", or use the same "
          "reference state");
  }

  std::vector<double> numbers(const std::string& name, const dimension& wanted) const {
    std::vector<double> values = file_.read(name);
    const std::string unit = file_.units(name);
    for (double& value : values)
      value = in_units_of_case(value, unit, fmt::format("'{}'", name), wanted, scales_);
    return values;
  }

  /// Returns a number on a line, otherwise a table of the values in the cells at the side.
  std::string formula(const std::string& name, const dimension& wanted) const {
    const std::vector<double> values = numbers("fields/" + name, wanted);
    const auto count = std::accumulate(shape_.begin(), shape_.end(), std::size_t{1}, std::multiplies<>());
    std::vector<std::size_t> along;  // directions along the side
    std::vector<std::vector<double>> centres;
    for (std::size_t k = 0; k < shape_.size(); ++k) {
      if (k == at(where_.direction)) continue;
      along.push_back(k);
      centres.push_back(numbers(coordinate(k), dimensions::length));
      if (centres.back().size() != shape_[k] || values.size() != count)
        throw input_error(fmt::format("'{}' and '{}' do not belong together (damaged file); give another",
                                      name, coordinate(k)));
    }
    if (along.empty()) return fmt::format("{}", values.at(where_.upper ? shape_[0] - 1 : 0));
    if (along.size() == 1) return along_side(name, coordinate(along[0]), centres[0], values_at_side(values));
    return over_side(name, {coordinate(along[0]), coordinate(along[1])}, centres, values_at_side(values));
  }

  static std::string coordinate(std::size_t direction) { return std::string(1, "xyz"[direction]); }

  /// Returns the values of the cells at the side, in their order in the file.
  std::vector<double> values_at_side(const std::vector<double>& values) const {
    const std::size_t side = at(where_.direction), last = where_.upper ? shape_[side] - 1 : 0;
    std::size_t stride = 1;
    for (std::size_t k = side + 1; k < shape_.size(); ++k) stride *= shape_[k];
    std::vector<double> found;
    for (std::size_t k = 0; k < values.size(); ++k)
      if (k / stride % shape_[side] == last) found.push_back(values[k]);
    return found;
  }

  [[noreturn]] static void fail_without_gas(const std::string& name) {
    throw input_error(fmt::format("'{}' has no values at this side (solid cells); give another side", name));
  }

  /// Returns a table without the cells in solids.
  static std::string along_side(const std::string& name, const std::string& argument,
                                const std::vector<double>& centres, const std::vector<double>& values) {
    std::vector<std::pair<double, double>> points;
    for (std::size_t k = 0; k < centres.size(); ++k)
      if (std::isfinite(values[k])) points.emplace_back(centres[k], values[k]);
    if (points.empty()) fail_without_gas(name);
    return formula_of_table(argument, points);
  }

  /// Returns a table in which cells in solids have the value of the nearest cell with gas.
  static std::string over_side(const std::string& name, const std::array<std::string, 2>& arguments,
                               const std::vector<std::vector<double>>& centres,
                               const std::vector<double>& values) {
    const std::vector<double>&first = centres[0], &second = centres[1];
    if (values.size() > most_cells)
      throw input_error(
          fmt::format("it has {} cells at this side (at most {} become part of a case); give a "
                      "coarser result",
                      values.size(), most_cells));
    std::vector<std::size_t> with_gas;
    for (std::size_t k = 0; k < values.size(); ++k)
      if (std::isfinite(values[k])) with_gas.push_back(k);
    if (with_gas.empty()) fail_without_gas(name);
    const std::size_t n = second.size();
    const auto nearest = [&](std::size_t to) {
      const auto distance = [&](std::size_t k) {
        return std::hypot(first[k / n] - first[to / n], second[k % n] - second[to % n]);
      };
      return *std::min_element(with_gas.begin(), with_gas.end(),
                               [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
    };
    std::vector<double> filled = values;
    for (std::size_t k = 0; k < values.size(); ++k)
      if (!std::isfinite(values[k])) filled[k] = values[nearest(k)];
    return formula_of_table(arguments[1], arguments[0], second, first, filled);
  }

  hdf5_file file_;
  face where_;
  const std::optional<gas_scales>& scales_;
  hdf5_file::shape shape_;
};

std::size_t face_with_name(const std::string& name) {
  const auto found = std::find(face_names.begin(), face_names.end(), name);
  if (found == face_names.end())
    throw input_error(fmt::format("unknown side '{}' (no face has this name); {}", shown(name),
                                  suggest(name, {face_names.begin(), face_names.end()})));
  return static_cast<std::size_t>(found - face_names.begin());
}

std::size_t dimensions_of(const case_text& text) {
  const raw_value* cells = text.find("space.cells");
  const auto* list = cells == nullptr ? nullptr : std::get_if<raw_value::list>(&cells->value);
  return list == nullptr ? 1 : list->size();
}

const std::string& text_of(const raw_value& raw, const std::string& path, const char* example) {
  const auto* found = std::get_if<std::string>(&raw.value);
  if (found == nullptr || found->empty()) refuse(raw, path, "it must be a text", example);
  return *found;
}

/// Returns the side of the result for a face: `side`, or the face itself.
face side_for(const case_text& text, const std::string& table, const source_place& place) {
  const std::size_t own = at_place(place, [&] { return face_with_name(table.substr(table.rfind('.') + 1)); });
  const std::string path = table + ".profile.side";
  const raw_value* side = text.find(path);
  if (side == nullptr) return face_of(own);
  const std::string& name = text_of(*side, path, "write for example side = \"right\"");
  const std::size_t theirs = at_place(side->place, [&] { return face_with_name(name); });
  if (face_of(own).direction != face_of(theirs).direction)
    refuse(*side, path, "it has another direction than the face",
           fmt::format("give {} or {}", face_names[own / 2 * 2], face_names[own / 2 * 2 + 1]));
  return face_of(theirs);
}

std::map<std::string, std::vector<std::string>> formulas_of(const case_text& text, const std::string& table,
                                                            const raw_value& file,
                                                            const std::optional<gas_scales>& scales) {
  const std::string& path =
      text_of(file, table + profile_key, "write for example file = \"results/earlier/solution.h5\"");
  const face where = side_for(text, table, file.place);
  try {
    const earlier_side from(path, where, scales);
    const std::size_t wanted = dimensions_of(text);
    if (from.dimensions() != wanted)
      throw input_error(fmt::format("it has {} space dimension{} (the case has {}); give another result",
                                    from.dimensions(), from.dimensions() == 1 ? "" : "s", wanted));
    return from.formulas();
  } catch (const error& problem) {
    throw input_error(file.place, fmt::format("'{}{}' = \"{}\" cannot be used: {}", table, profile_key,
                                              shown(path), problem.what()));
  }
}

}  // namespace

void read_profiles(case_text& text, const std::optional<gas_scales>& scales) {
  std::map<std::string, raw_value> made;
  std::vector<std::string> tables;
  for (const auto& [path, raw] : text.values) {
    if (path.rfind("boundary.", 0) != 0 || !path.ends_with(profile_key)) continue;
    const std::string table = path.substr(0, path.size() - profile_key.size());
    const auto formulas = formulas_of(text, table, raw, scales);
    for (const auto& [name, components] : formulas) {
      const std::string variable = fmt::format("{}.{}", table, name);
      if (text.find(variable) != nullptr)
        throw input_error(raw.place, fmt::format("'{}' conflicts with '{}' (both give the value); remove one "
                                                 "of them",
                                                 path, variable));
      raw_value::list items;
      for (const auto& one : components)
        items.push_back({one, fmt::format("a profile in '{}'", path), raw.place, raw.place});
      made.emplace(variable,
                   raw_value{std::move(items), fmt::format("a profile in '{}'", path), raw.place, raw.place});
    }
    tables.push_back(table);
  }
  for (const auto& table : tables) {
    text.values.erase(table + profile_key);
    text.values.erase(table + ".profile.side");
  }
  text.values.merge(made);
}

}  // namespace apsis
