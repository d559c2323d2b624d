#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace apsis {

/// The function of a formula `table(a, a_0, v_0, a_1, v_1, …)`: linear interpolation between its points,
/// constant before the first and after the last one.
class formula_table {
 public:
  static constexpr std::size_t most_points = 100'000;  ///< of one table

  /// At least one point; arguments increase.
  explicit formula_table(std::vector<std::pair<double, double>> points) : points_(std::move(points)) {}

  /// Returns the value; NaN of NaN. Thread-safe.
  double at(double a) const;

 private:
  std::vector<std::pair<double, double>> points_;
};

/// A formula without the points of its tables.
struct text_of_tables {
  std::string text;                   ///< with a call `name_of_table(k)(a)` in place of table k
  std::vector<formula_table> tables;  ///< in their order
  /// Positions in `text` at which points were taken out, and their numbers of characters.
  std::vector<std::pair<std::size_t, std::size_t>> cuts;

  /// Returns the position in the formula of a position in `text`.
  std::size_t position_in_formula(std::size_t at) const {
    std::size_t moved = at;
    for (const auto& [cut, characters] : cuts) moved += cut <= at ? characters : 0;
    return moved;
  }
};

/// Returns the function by which text_of_tables::text calls table k < most_tables.
std::string name_of_table(std::size_t k);
inline constexpr std::size_t most_tables = 100;  ///< of a formula

/// Takes the tables out of a formula. Calls `fail`, which throws, with the position of what is wrong, the
/// reason and a suggestion: no list of points, a point that is not a number, arguments that do not increase,
/// or too many.
text_of_tables take_tables(
    const std::string& formula,
    const std::function<void(std::size_t at, const std::string& why, const std::string& advice)>& fail);

/// Returns the formula of a table in `argument` through points, with all digits.
std::string formula_of_table(std::string_view argument, const std::vector<std::pair<double, double>>& points);

}  // namespace apsis
