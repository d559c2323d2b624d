#include <apsis/config/reference_reader.hpp>

#include <apsis/config/case_value.hpp>
#include <apsis/core/index.hpp>
#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

class reader_of_reference {
 public:
  reader_of_reference(const case_text& text, const model& equation, case_config& config)
      : text_(text), equation_(equation), config_(config) {}

  void read() {
    const auto place = place_of_table();
    if (!place) return;
    check_case(*place);
    check_names();
    reference_values values;
    values.about_axis = config_.is_axisymmetric();
    for (const reference_key& key : keys()) take(key, *place, values);
    if (values.centre.empty() && !values.about_axis) values.centre.assign(at(dimensions()), 0.0);
    check_directions(values);
    config_.output.reference = std::move(values);
  }

 private:
  int dimensions() const { return static_cast<int>(config_.space.cells.size()); }

  static std::string path_of(const std::string& name) { return fmt::format("{}.{}", reference_table, name); }

  /// Returns the place of the table, or of its first key on the command line.
  std::optional<source_place> place_of_table() const {
    const std::string head = path_of("");
    if (const auto table = text_.tables.find(reference_table); table != text_.tables.end())
      return table->second;
    for (const auto& [path, raw] : text_.values)
      if (path == reference_table || path.rfind(head, 0) == 0) return raw.place;
    return std::nullopt;
  }

  void check_case(const source_place& place) const {
    if (const raw_value* raw = text_.find(reference_table))
      refuse(*raw, reference_table, "it is a table", fmt::format("write [{}]", reference_table));
    const auto unused = [&](const std::string& why) {
      throw input_error(place,
                        fmt::format("the table [{}] is not used ({}); remove it", reference_table, why));
    };
    if (equation_.as_gas() == nullptr) unused("coefficients are those of a gas");
    if (dimensions() < 2) unused("coefficients need two or three space dimensions");
    if (equation_.velocities().dimensions() < dimensions())
      unused("forces need a velocity for each direction of space");
    if (config_.solids.empty() && config_.bodies.empty() && config_.output.surfaces.empty())
      unused("the case has neither bodies nor output.surfaces");
  }

  /// Returns the keys that a case with this number of dimensions has.
  std::vector<reference_key> keys() const {
    std::vector<reference_key> all = reference_keys();
    std::erase_if(all, [&](const auto& key) {
      if (config_.is_axisymmetric()) return !key.about_axis;
      return key.only_in != 0 && key.only_in != dimensions();
    });
    return all;
  }

  void check_names() const {
    const std::string head = path_of("");
    std::vector<std::string> names;
    for (const reference_key& key : keys()) names.emplace_back(key.name);
    for (const auto& [path, raw] : text_.values) {
      if (path.rfind(head, 0) != 0) continue;
      const std::string name = path.substr(head.size());
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      throw input_error(
          raw.place, fmt::format("unknown key '{}' (reference values in {} dimensions have no such key); {}",
                                 shown(path), dimensions(), suggest(name, names)));
    }
  }

  void take(const reference_key& key, const source_place& table, reference_values& values) const {
    const std::string path = path_of(key.name);
    const raw_value* raw = text_.find(path);
    if (raw == nullptr) {
      if (!key.required) return;
      throw input_error(table, fmt::format("key '{}' is missing (coefficients need it); add it, for example: "
                                           "{} = {}",
                                           path, key.name, example(key)));
    }
    const std::vector<double> found = constant_numbers(*raw, path, config_.constants);
    if (!std::all_of(found.begin(), found.end(), [](double x) { return std::isfinite(x); }))
      refuse(*raw, path, "it must be finite", "give finite numbers");
    if (key.vector != nullptr) {
      if (found.size() != at(dimensions()))
        refuse(*raw, path, fmt::format("it has {} components here", dimensions()),
               fmt::format("write for example {}", example(key)));
      values.*key.vector = found;
      return;
    }
    if (found.size() != 1 || std::holds_alternative<raw_value::list>(raw->value))
      refuse(*raw, path, "it must be a number", fmt::format("write for example {} = 1", key.name));
    if (key.positive && !(found.front() > 0.0))
      refuse(*raw, path, "it must be above 0", "give a larger number");
    values.*key.number = found.front();
  }

  std::string example(const reference_key& key) const {
    if (key.vector == nullptr) return "1";
    return dimensions() == 2 ? "[1, 0]" : "[1, 0, 0]";
  }

  void check_directions(const reference_values& values) const {
    const auto refuse_vector = [&](const char* name, const char* why) {
      const std::string path = path_of(name);
      refuse(*text_.find(path), path, why, "give another vector");
    };
    if (!(values.speed() > 0.0)) refuse_vector("velocity", "a stream at rest has no direction");
    if (values.about_axis && values.velocity[1] != 0.0)
      refuse_vector("velocity", "a stream across the axis is not axisymmetric");
    const auto lift = values.lift_direction();
    if (!std::all_of(lift.begin(), lift.end(), [](double x) { return std::isfinite(x); }))
      refuse_vector("up", "it has no part across the velocity");
  }

  const case_text& text_;
  const model& equation_;
  case_config& config_;
};

}  // namespace

void read_reference_values(const case_text& text, const model& equation, case_config& config) {
  reader_of_reference(text, equation, config).read();
}

}  // namespace apsis
