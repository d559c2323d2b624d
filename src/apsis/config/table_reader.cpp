#include <apsis/config/table_reader.hpp>

#include <apsis/config/case_units.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/model/formula_table.hpp>
#include <apsis/output/column_file.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Returns "boundary.left.T" for "boundary.left.T.file"; "" for other keys.
std::string owner_of(const std::string& path, const std::string& key) {
  for (const char* table : {"boundary.", "space.solid.", "space.body."}) {
    if (path.rfind(table, 0) != 0 || !path.ends_with("." + key)) continue;
    const std::string owner = path.substr(0, path.size() - key.size() - 1);
    const std::string below = owner.substr(std::string(table).size());
    // `below` is a face or a number, and a variable.
    if (std::count(below.begin(), below.end(), '.') == 1) return owner;
  }
  return "";
}

class reader_of_table {
 public:
  reader_of_table(const raw_value& file, std::string path, const dimension_lookup& dimension_of,
                  const std::optional<gas_scales>& scales)
      : place_(file.place), path_(std::move(path)), scales_(scales) {
    const auto* name = std::get_if<std::string>(&file.value);
    if (name == nullptr || name->empty())
      refuse(file, path_ + ".file", "it must be a text", "write for example file = \"pump.csv\"");
    file_ = *name;
    dimension_ = dimension_of(path_).value_or(dimensions::none);
    try {
      table_ = read_columns(file_);
    } catch (const io_error& problem) {
      fail(problem.what());
    } catch (const input_error& problem) {
      fail(problem.what());
    }
    for (const auto& [head, values] : table_.columns) heads_.emplace(name_of(head), head);
    read_times();
  }

  /// Returns the value of the key: formulas of the columns that `column` names, or of those of the variable.
  raw_value value(const raw_value* column) const {
    const std::string variable = path_.substr(path_.rfind('.') + 1);
    if (column != nullptr) return named(*column);
    if (heads_.contains(variable)) return text(formula(variable));
    raw_value::list components;
    std::size_t last = 0;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const std::string one = fmt::format("{}_{}", variable, axes[k]);
      components.push_back(heads_.contains(one) ? text(formula(one)) : text("0"));
      if (heads_.contains(one)) last = k + 1;
    }
    if (last == 0) missing(variable);
    components.resize(last);
    return {std::move(components), fmt::format("a table in '{}'", file_), place_, place_};
  }

 private:
  static constexpr std::array<char, 3> axes = {'x', 'y', 'z'};

  [[noreturn]] void fail(const std::string& problem) const {
    throw input_error(place_,
                      fmt::format("'{}.file' = \"{}\" cannot be used: {}", path_, shown(file_), problem));
  }

  [[noreturn]] void missing(const std::string& name) const {
    std::vector<std::string> known;
    for (const auto& [one, head] : heads_) known.push_back(one);
    fail(fmt::format("it has no column '{}' (the first line names others); {}", shown(name),
                     suggest(name, known)));
  }

  raw_value text(std::string formula) const {
    return {std::move(formula), fmt::format("a table in '{}'", file_), place_, place_};
  }

  raw_value named(const raw_value& column) const {
    if (const auto* name = std::get_if<std::string>(&column.value)) return text(formula(*name));
    const auto* list = std::get_if<raw_value::list>(&column.value);
    if (list == nullptr || list->empty())
      refuse(column, path_ + ".column", "it must be the name of a column, or a list of names and numbers",
             "write for example column = \"T\"");
    raw_value::list components;
    for (const raw_value& item : *list) components.push_back(named(item, column));
    return {std::move(components), column.what, place_, place_};
  }
  raw_value named(const raw_value& item, const raw_value& column) const {
    if (const auto* name = std::get_if<std::string>(&item.value)) return text(formula(*name));
    return text(fmt::format("{}", finite_number(item.value.index() == 0 ? column : item, path_ + ".column",
                                                "the name of a column or a number")));
  }

  static std::string name_of(const std::string& head) {
    const std::string name = head.substr(0, head.find('['));
    const auto end = name.find_last_not_of(" \t");
    return end == std::string::npos ? "" : name.substr(0, end + 1);
  }

  /// Returns the unit in brackets; "" without one.
  std::string unit_of_head(const std::string& head) const {
    const auto open = head.find('[');
    if (open == std::string::npos) return "";
    if (head.back() != ']' || head.size() < open + 3)
      fail(
          fmt::format("'{}' is no head of a column (a name, or a name and a unit in brackets, is needed); "
                      "write for example \"p [Pa]\"",
                      shown(head)));
    return head.substr(open + 1, head.size() - open - 2);
  }

  /// Returns a column in units of the case.
  std::vector<double> column(const std::string& name, const dimension& wanted) const {
    const auto found = heads_.find(name);
    if (found == heads_.end()) missing(name);
    if (const auto problem = table_.problems.find(found->second); problem != table_.problems.end())
      fail(problem->second);
    std::vector<double> values = table_.columns.at(found->second);
    const std::string unit = unit_of_head(found->second);
    if (unit.empty()) return values;
    try {
      for (double& value : values)
        value = in_units_of_case(value, unit, fmt::format("column '{}'", name), wanted, scales_);
    } catch (const input_error& problem) {
      fail(problem.what());
    }
    return values;
  }

  void read_times() {
    times_ = column("t", dimensions::time);
    if (times_.size() > formula_table::most_points)
      fail(fmt::format("it has {} rows (at most {} are read); leave some out", times_.size(),
                       formula_table::most_points));
    for (std::size_t k = 1; k < times_.size(); ++k)
      if (!(times_[k] > times_[k - 1]))
        fail(fmt::format("{}t does not increase in column 't' ({:.10g} after {:.10g}); sort the rows",
                         to_string({file_, table_.lines[k], 0}), times_[k], times_[k - 1]));
  }

  std::string formula(const std::string& name) const {
    const std::vector<double> values = column(name, dimension_);
    std::vector<std::pair<double, double>> points;
    for (std::size_t k = 0; k < times_.size(); ++k) points.emplace_back(times_[k], values[k]);
    return formula_of_table("t", points);
  }

  source_place place_;
  std::string path_, file_;
  const std::optional<gas_scales>& scales_;
  dimension dimension_ = dimensions::none;
  column_file table_;
  std::map<std::string, std::string> heads_;  ///< heads of columns, by names without units
  std::vector<double> times_;
};

}  // namespace

void read_tables_in_time(case_text& text, const dimension_lookup& dimension_of,
                         const std::optional<gas_scales>& scales) {
  std::map<std::string, raw_value> made;
  for (const auto& [path, raw] : text.values) {
    const std::string owner = owner_of(path, "file");
    if (owner.empty()) continue;
    if (text.find(owner) != nullptr)
      throw input_error(raw.place,
                        fmt::format("'{}' conflicts with '{}' (both give the value); remove one of "
                                    "them",
                                    path, owner));
    made.emplace(owner,
                 reader_of_table(raw, owner, dimension_of, scales).value(text.find(owner + ".column")));
  }
  for (auto& [owner, value] : made) {
    text.values.erase(owner + ".file");
    text.values.erase(owner + ".column");
    text.values.emplace(owner, std::move(value));
  }
}

}  // namespace apsis
