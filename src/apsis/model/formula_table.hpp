#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace apsis {

/// The function of a formula `table(a, a_1, v_1, a_2, v_2, …)`, or of one with two arguments,
/// `table2(a, b, n, a_1, …, a_n, b_1, v_11, …, v_n1, b_2, v_12, …)`: linear interpolation in each argument
/// between its points, constant before the first and after the last one.
class formula_table {
 public:
  static constexpr std::size_t most_points = 100'000;  ///< of one table

  /// A function of one argument: at least one point; arguments increase.
  explicit formula_table(const std::vector<std::pair<double, double>>& points);
  /// A function of two arguments: values[j * a.size() + i] at (a_i, b_j); both have at least one number, and
  /// increase.
  formula_table(std::vector<double> a, std::vector<double> b, std::vector<double> values)
      : a_(std::move(a)), b_(std::move(b)), values_(std::move(values)) {}

  /// Returns the number of arguments, 1 or 2.
  int arguments() const { return b_.empty() ? 1 : 2; }
  /// Returns the value; NaN of NaN. Thread-safe.
  double at(double a, double b = 0.0) const;

 private:
  std::vector<double> a_, b_, values_;
};

/// A formula without the points of its tables.
struct text_of_tables {
  std::string text;                   ///< with a call of names[k] in place of table k
  std::vector<formula_table> tables;  ///< in their order
  std::vector<std::string> names;     ///< of the functions by which `text` calls them
  /// Positions in `text` at which points were taken out, and their numbers of characters.
  std::vector<std::pair<std::size_t, std::size_t>> cuts;

  /// Returns the position in the formula of a position in `text`.
  std::size_t position_in_formula(std::size_t at) const {
    std::size_t moved = at;
    for (const auto& [cut, characters] : cuts) moved += cut <= at ? characters : 0;
    return moved;
  }
};

inline constexpr std::size_t most_tables = 100;  ///< of a formula

/// Takes the tables out of a formula. Calls `fail`, which throws, with the position of an error, the reason
/// and a suggestion: no list of points, a point that is not a number, arguments that do not increase, or too
/// many.
text_of_tables take_tables(
    const std::string& formula,
    const std::function<void(std::size_t at, const std::string& why, const std::string& advice)>& fail);

/// Returns the formula of a table in `argument` through points, with all digits.
std::string formula_of_table(std::string_view argument, const std::vector<std::pair<double, double>>& points);
/// Returns the formula of a table in the arguments `of_a` and `of_b` through values[j * a.size() + i] at
/// (a_i, b_j), with all digits.
std::string formula_of_table(std::string_view of_a, std::string_view of_b, const std::vector<double>& a,
                             const std::vector<double>& b, const std::vector<double>& values);

}  // namespace apsis
