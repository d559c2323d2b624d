#include <validation/comparison.hpp>

#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace apsis::validation {
namespace {

using json = nlohmann::ordered_json;

/// Returns the value of a parameter in a comparison; its default if the comparison does not set it.
std::string value_of(const compared_value& one, const quantity_parameter& parameter) {
  const auto found = one.reference->at.find(parameter.name);
  return found == one.reference->at.end() ? parameter.value : found->second;
}

/// Returns the settings other than the first parameter, as a label.
std::string others(const compared_value& one) {
  quantity_values rest = one.reference->at;
  rest.erase(one.quantity->parameters.front().name);
  return fmt::format("{}", fmt::join(settings_of(rest), " "));
}

panel log_panel(const std::string& title, const std::string& x, const std::string& y) {
  panel out;
  out.title = title;
  out.x_label = x;
  out.y_label = y;
  out.log_x = out.log_y = true;
  return out;
}

}  // namespace

std::string to_string(origin from) {
  switch (from) {
    case origin::published:
      return "published";
    case origin::theory:
      return "theory";
    default:
      return "computed";
  }
}

double compared_value::difference() const {
  return value / reference->value - 1.0;
}

bool compared_value::holds() const {
  return std::abs(difference()) <= reference->tolerance;
}

std::vector<std::string> settings_of(const quantity_values& values) {
  std::vector<std::string> settings;
  for (const auto& [name, value] : values) settings.push_back(fmt::format("{}={}", name, value));
  return settings;
}

compared_value compare_with_reference(const quantity_entry& quantity, const reference_value& reference,
                                      const std::function<bool(double)>& progress) {
  const auto start = std::chrono::steady_clock::now();
  compared_value one{&quantity, &reference};
  one.value = compute_quantity(quantity, settings_of(reference.at), progress);
  one.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return one;
}

picture quantity_picture(const quantity_entry& quantity, const std::vector<compared_value>& values) {
  const quantity_parameter& first = quantity.parameters.front();
  panel shown = log_panel("value", first.name, quantity.name);
  panel differences = log_panel("relative difference", first.name, "|computed/reference - 1|");
  struct group {
    std::vector<double> x, computed, reference, difference, tolerance;
  };
  std::map<std::string, group> groups;
  std::set<double> abscissae;
  for (const auto& one : values) {
    const double x = std::stod(value_of(one, first));
    abscissae.insert(x);
    group& to = groups[others(one)];
    to.x.push_back(x);
    to.computed.push_back(one.value);
    to.reference.push_back(one.reference->value);
    to.difference.push_back(std::abs(one.difference()));
    to.tolerance.push_back(one.reference->tolerance);
  }
  picture out{quantity.name,
              quantity.name,
              quantity.description + ". Source of the references: " + quantity.source + ".",
              {}};
  if (abscissae.size() < 3) return out;
  shown.log_x = differences.log_x = *abscissae.begin() > 0.0;
  // Several groups have a name each. Lines are then computed values, and open markers references.
  const bool alone = groups.size() == 1;
  int colour = 0;
  for (const auto& [label, of] : groups) {
    const std::string name = label.empty() ? "default" : label;
    shown.curves.push_back({alone ? "computed" : name, of.x, of.computed, curve_style::line, colour});
    shown.curves.push_back({alone ? "reference" : "", of.x, of.reference, curve_style::markers, colour});
    differences.curves.push_back(
        {alone ? "difference" : name, of.x, of.difference, curve_style::line_and_markers, colour});
    differences.curves.push_back({alone ? "tolerance" : "", of.x, of.tolerance, curve_style::dashed, colour});
    ++colour;
  }
  if (!alone) out.caption += " Lines: computed; open markers: references; dashed: tolerance.";
  out.panels = {shown, differences};
  return out;
}

json to_json(const quantity_entry& quantity, const std::vector<compared_value>& values) {
  json compared = json::array();
  for (const auto& one : values)
    compared.push_back({{"settings", settings_of(one.reference->at)},
                        {"value", one.value},
                        {"reference", one.reference->value},
                        {"origin", to_string(one.reference->from)},
                        {"difference", one.difference()},
                        {"tolerance", one.reference->tolerance},
                        {"holds", one.holds()},
                        {"wall_s", one.wall_s}});
  json pictures = json::array();
  const picture drawn = quantity_picture(quantity, values);
  if (!drawn.panels.empty()) pictures.push_back(to_json(drawn));
  return {{"name", quantity.name},
          {"description", quantity.description},
          {"source", quantity.source},
          {"values", compared},
          {"pictures", pictures}};
}

}  // namespace apsis::validation
