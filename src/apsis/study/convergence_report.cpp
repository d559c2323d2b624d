#include <apsis/study/convergence_report.hpp>

#include <apsis/config/case_json.hpp>
#include <apsis/config/discretization_of_case.hpp>
#include <apsis/method/time_integrator.hpp>
#include <apsis/study/settings.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace apsis {
namespace {

using json = nlohmann::ordered_json;

json number(double x) {
  return std::isfinite(x) ? json(x) : json(nullptr);
}

/// Returns the value of a key in the run, as a number if possible.
json value_of(const convergence_row& row, const std::string& key) {
  const json all = to_json(row.config);
  json value = all;
  for (std::size_t from = 0; from != std::string::npos;) {
    const auto dot = key.find('.', from);
    const std::string part = key.substr(from, dot == std::string::npos ? dot : dot - from);
    value = value.is_object() && value.contains(part) ? value[part] : json(nullptr);
    from = dot == std::string::npos ? dot : dot + 1;
  }
  const double x = number_of(row.config, key);
  return value.is_string() && !std::isnan(x) ? json(x) : value;
}

json to_json(const convergence_table& table, const convergence_row& row) {
  json out = json::object();
  for (const auto& key : table.keys) out[key] = value_of(row, key);
  out["error"] = number(row.error);
  out["rate"] = number(row.rate);
  out["steps"] = row.steps;
  out["dt"] = number(row.dt);
  out["wall_s"] = number(row.wall_s);
  out["cpu_s"] = number(row.cpu_s);
  out["min_value"] = number(row.min_value);
  if (!row.problem.empty()) out["problem"] = row.problem;
  return out;
}

/// Returns a cell of a CSV file: numbers with 17 digits, text in quotes where it needs them.
std::string cell(const json& value) {
  if (value.is_null()) return "";
  if (value.is_number_float()) return fmt::format("{:.17g}", value.get<double>());
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out(1, '"');
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

std::string or_dash(const std::string& form, double x) {
  return std::isfinite(x) ? fmt::format(fmt::runtime(form), x) : "-";
}

/// Returns the values that distinguish the rows of a block.
std::string row_name(const convergence_table& table, const convergence_row& row) {
  return table.refined >= 0 ? row.values[static_cast<std::size_t>(table.refined)]
                            : fmt::format("{}", fmt::join(row.values, ", "));
}

/// Returns the value of a key in the label of a curve.
std::string label_part(const std::string& key, const std::string& value) {
  if (key == "model.epsilon") return "ε = " + value;
  if (key == "time.method" || key == "model.initial" || key == discretization_key) return value;
  return fmt::format("{} = {}", key.substr(key.find('.') + 1), value);
}

std::vector<std::string> outer_keys(const convergence_table& table) {
  std::vector<std::string> keys = table.keys;
  if (table.refined >= 0) keys.erase(keys.begin() + table.refined);
  return keys;
}

/// Returns the index of the key with one panel per value; −1 for a single panel. Of several keys it is the
/// one with the fewest values, to avoid crowded panels.
int panel_key(const convergence_table& table) {
  constexpr std::size_t most_panels = 6;
  const std::size_t count = outer_keys(table).size();
  int chosen = -1, long_lists = 0;
  std::size_t fewest = most_panels + 1;
  for (std::size_t k = 0; k < count; ++k) {
    std::set<std::string> values;
    for (const auto& block : table.blocks) values.insert(block.values[k]);
    if (values.size() < 2) continue;
    ++long_lists;
    if (values.size() >= fewest) continue;
    fewest = values.size();
    chosen = static_cast<int>(k);
  }
  return long_lists > 1 ? chosen : -1;
}

/// Returns the curves of the blocks that have `value` for the key of the panels (of all blocks
/// without such a key).
panel panel_of(const convergence_table& table, int key, const std::string& value) {
  const auto keys = outer_keys(table);
  panel axes{"", table.h_name + " (dimensionless)", table.measured + " (dimensionless)", true, true, {}, {},
             {}};
  if (key >= 0) axes.title = label_part(keys[static_cast<std::size_t>(key)], value);
  std::set<int> orders;
  for (const auto& block : table.blocks) {
    if (key >= 0 && block.values[static_cast<std::size_t>(key)] != value) continue;
    std::vector<std::string> parts;
    for (std::size_t k = 0; k < keys.size(); ++k)
      if (static_cast<int>(k) != key) parts.push_back(label_part(keys[k], block.values[k]));
    curve c{fmt::format("{}", fmt::join(parts, ", ")), {}, {}};
    for (const auto& row : block.rows) {
      c.x.push_back(row.h);
      c.y.push_back(row.error);
      orders.insert(find_integrator(row.config.time.method).order);
    }
    axes.curves.push_back(std::move(c));
  }
  if (table.h_name == "Δt" || table.h_name == "Δx") axes.slopes.assign(orders.begin(), orders.end());
  return axes;
}

}  // namespace

std::string to_text(const convergence_table& table) {
  std::string out = fmt::format("{}\n{}\n", table.title, table.measure);
  const std::string head = table.refined >= 0 ? table.keys[static_cast<std::size_t>(table.refined)]
                                              : fmt::format("{}", fmt::join(table.keys, ", "));
  std::size_t width = head.size();
  for (const auto& block : table.blocks)
    for (const auto& row : block.rows) width = std::max(width, row_name(table, row).size());
  for (const auto& block : table.blocks) {
    out += fmt::format("\n{}{}", block.title, block.title.empty() ? "" : "\n");
    out += fmt::format("  {:>{}}  {:>10}  {:>6}  {:>9}  {:>10}  {:>8}  {:>10}\n", head, width, table.measured,
                       "rate", "steps", "dt", "cpu_s", "min_value");
    for (const auto& row : block.rows) {
      out += fmt::format("  {:>{}}  {:>10}  {:>6}  {:>9}  {:>10}  {:>8}  {:>10}\n", row_name(table, row),
                         width, or_dash("{:.3e}", row.error), or_dash("{:.2f}", row.rate), row.steps,
                         or_dash("{:.4e}", row.dt), or_dash("{:.2f}", row.cpu_s),
                         or_dash("{:.3e}", row.min_value));
      if (!row.problem.empty()) out += fmt::format("  {:>{}}  {}\n", "", width, row.problem);
    }
  }
  return out;
}

std::string to_csv(const convergence_table& table) {
  std::vector<std::string> columns = table.keys;
  for (const char* name : {"error", "rate", "steps", "dt", "wall_s", "cpu_s", "min_value", "problem"})
    columns.emplace_back(name);
  std::string out = fmt::format("{}\n", fmt::join(columns, ","));
  for (const json& row : to_json(table)) {
    std::vector<std::string> cells;
    for (const auto& name : columns) cells.push_back(row.contains(name) ? cell(row[name]) : "");
    out += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return out;
}

json to_json(const convergence_table& table) {
  json rows = json::array();
  for (const auto& block : table.blocks)
    for (const auto& row : block.rows) rows.push_back(to_json(table, row));
  return rows;
}

picture to_picture(const convergence_table& table) {
  picture p{"converge", table.title, fmt::format("The {}.", table.measure), {}};
  if (table.refined < 0) return p;
  if (table.h_name == "Δt" || table.h_name == "Δx") p.caption += " Triangles: orders of the methods.";
  const int key = panel_key(table);
  std::set<std::string> drawn;
  for (const auto& block : table.blocks) {
    const std::string value = key < 0 ? "" : block.values[static_cast<std::size_t>(key)];
    if (drawn.insert(value).second) p.panels.push_back(panel_of(table, key, value));
  }
  return p;
}

}  // namespace apsis
