#include <apsis/output/picture.hpp>

#include <cmath>

#include <nlohmann/json.hpp>

namespace apsis {
namespace {

using json = nlohmann::ordered_json;

const char* style_name(curve_style style) {
  switch (style) {
    case curve_style::line:
      return "line";
    case curve_style::dashed:
      return "dashed";
    case curve_style::dash_dot:
      return "dash_dot";
    case curve_style::markers:
      return "markers";
    case curve_style::line_and_markers:
      return "line_and_markers";
    case curve_style::dashed_and_markers:
      return "dashed_and_markers";
  }
  return "line";
}

/// Returns the numbers, with null in place of NaN and infinity, which JSON lacks.
json numbers(const std::vector<double>& values) {
  json out = json::array();
  for (const double value : values) out.push_back(std::isfinite(value) ? json(value) : json(nullptr));
  return out;
}

json to_json(const curve& c) {
  return {{"label", c.label},
          {"style", style_name(c.style)},
          {"colour", c.colour},
          {"x", numbers(c.x)},
          {"y", numbers(c.y)}};
}

json to_json(const heat_map& m) {
  json rows = json::array();
  for (const auto& row : m.value) rows.push_back(numbers(row));
  return {{"label", m.label}, {"x", numbers(m.x)},  {"y", numbers(m.y)},
          {"value", rows},    {"lowest", m.lowest}, {"highest", m.highest}};
}

json to_json(const panel& p) {
  json curves = json::array(), maps = json::array();
  for (const auto& c : p.curves) curves.push_back(to_json(c));
  for (const auto& m : p.maps) maps.push_back(to_json(m));
  return {{"title", p.title}, {"x_label", p.x_label}, {"y_label", p.y_label}, {"log_x", p.log_x},
          {"log_y", p.log_y}, {"slopes", p.slopes},   {"curves", curves},     {"maps", maps}};
}

}  // namespace

json to_json(const picture& p) {
  json panels = json::array();
  for (const auto& one : p.panels) panels.push_back(to_json(one));
  return {{"name", p.name}, {"title", p.title}, {"caption", p.caption}, {"panels", panels}};
}

}  // namespace apsis
