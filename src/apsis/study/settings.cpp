#include <apsis/study/settings.hpp>

#include <apsis/config/case_schema.hpp>
#include <apsis/model/expression.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace apsis {
namespace {

using texts = std::vector<std::string>;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Returns the distance between neighbouring velocities along a direction, in the mean if it varies.
double velocity_spacing(const case_config& config, std::size_t direction) {
  const auto item = [direction](const auto& list) {
    return list.size() == 1 ? list.front() : list.at(direction);
  };
  const auto& given = config.velocity;
  if (given.set.empty() || item(given.set) == "uniform") return 2.0 * given.max / item(given.points.each());
  // Velocities of rings are given along the axis, which is the last component of a gas on a line r.
  const bool on_radius = config.is_axisymmetric() && config.space.cells.size() == 1;
  const auto equation = make_model(config);
  const auto speeds = equation->speeds(on_radius ? 2 : static_cast<int>(direction));
  std::vector<double> v(speeds.begin(), speeds.end());
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
  return v.size() < 2 ? not_a_number : (v.back() - v.front()) / static_cast<double>(v.size() - 1);
}

}  // namespace

bool is_resolution_key(const std::string& key) {
  return is_step_key(key) || key == "space.cells" || key == "velocity.points";
}

std::string key_of(const std::string& setting) {
  return setting.substr(0, setting.find('='));
}

texts layered(const texts& lower, const texts& upper) {
  const bool sets_step = std::any_of(upper.begin(), upper.end(),
                                     [](const std::string& item) { return is_step_key(key_of(item)); });
  texts out;
  for (const auto& item : lower) {
    const bool replaced = std::any_of(upper.begin(), upper.end(), [&item](const std::string& other) {
      return key_of(other) == key_of(item);
    });
    if (!replaced && !(sets_step && is_step_key(key_of(item)))) out.push_back(item);
  }
  out.insert(out.end(), upper.begin(), upper.end());
  return out;
}

std::string numerical_identity(case_config config) {
  config.title.clear();
  config.output = {};
  // 1/4 and 0.25 are the same.
  if (const double x = number_of(config, "model.epsilon"); !std::isnan(x))
    config.model.epsilon = fmt::format("{}", x);
  return to_toml(config);
}

double number_of(const case_config& config, const std::string& key) {
  const auto parameter = config.model.parameters.find(key.rfind("model.", 0) == 0 ? key.substr(6) : "");
  if (parameter != config.model.parameters.end()) return parameter->second;
  for (const case_key& entry : case_schema()) {
    if (entry.path != key) continue;
    const case_value value = entry.load(config);
    if (const auto* integer = std::get_if<long>(&value)) return static_cast<double>(*integer);
    if (const auto* number = std::get_if<double>(&value)) return *number;
    if (const auto* list = std::get_if<std::vector<long>>(&value))
      return list->size() == 1 ? static_cast<double>(list->front()) : not_a_number;
    if (entry.type != key_type::formula) break;
    const expression formula =
        key == "model.epsilon"
            ? make_epsilon(config, 3)
            : expression(std::get<std::string>(value), {}, formula_of_position(3, true, config.constants));
    return !formula.is_constant() ? not_a_number : formula.evaluate(position{});
  }
  return not_a_number;
}

double resolution(const case_config& config, const std::string& key, std::size_t direction) {
  if (key == "space.cells") {
    const auto& ends = config.space.domain.at(direction);
    return (ends[1] - ends[0]) / config.space.cells.at(direction);
  }
  return key == "velocity.points" ? velocity_spacing(config, direction) : number_of(config, key);
}

std::string resolution_name(const std::string& key) {
  if (key == "space.cells") return "Δx";
  if (key == "velocity.points") return "Δv";
  return is_step_key(key) ? "Δt" : key;
}

}  // namespace apsis
