#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace apsis {

/// The function of a formula `table(a, a_1, v_1, a_2, v_2, …)`, or with two arguments
/// `table2(a, b, n, a_1, …, a_n, b_1, v_11, …, v_n1, b_2, v_12, …)`. It interpolates linearly in each
/// argument between its points. Before the first and after the last point it is constant.
class formula_table {
 public:
  static constexpr std::size_t most_points = 100'000;  ///< largest number of points of a table

  /// Takes the points (a_i, v_i) of a function of one argument: at least one, with increasing a_i.
  explicit formula_table(const std::vector<std::pair<double, double>>& points);
  /// Takes a function of two arguments with the value values[j * a.size() + i] at (a_i, b_j). Both `a` and
  /// `b` increase and have at least one number.
  formula_table(std::vector<double> a, std::vector<double> b, std::vector<double> values)
      : a_(std::move(a)), b_(std::move(b)), values_(std::move(values)) {}

  /// Returns the number of arguments, 1 or 2.
  int arguments() const { return b_.empty() ? 1 : 2; }
  /// Returns the value at a or (a, b); NaN if an argument is NaN. Thread-safe.
  double at(double a, double b = 0.0) const;

 private:
  std::vector<double> a_, b_, values_;
};

/// A formula from which the points of tables have been removed.
struct text_of_tables {
  std::string text;                   ///< the formula, with a call of names[k] in place of table k
  std::vector<formula_table> tables;  ///< in the order of the text
  std::vector<std::string> names;     ///< names by which `text` calls the tables
  /// Positions in `text` where points were removed, with the number of removed characters.
  std::vector<std::pair<std::size_t, std::size_t>> cuts;

  /// Returns the position in the original formula for a position in `text`.
  std::size_t position_in_formula(std::size_t at) const {
    std::size_t moved = at;
    for (const auto& [cut, characters] : cuts) moved += cut <= at ? characters : 0;
    return moved;
  }
};

inline constexpr std::size_t most_tables = 100;  ///< most tables of a formula

/// Removes the points of tables from a formula. On an error it calls `fail`, which must throw, with the
/// position, the reason and a suggestion. Errors are a missing list of points, a point that is not a number,
/// arguments that do not increase, and too many points or tables.
text_of_tables take_tables(
    const std::string& formula,
    const std::function<void(std::size_t at, const std::string& why, const std::string& advice)>& fail);

/// Returns the formula of a table in `argument` through the points, with all digits.
std::string formula_of_table(std::string_view argument, const std::vector<std::pair<double, double>>& points);
/// Returns the formula of a table in the arguments `of_a` and `of_b` through values[j * a.size() + i] at
/// (a_i, b_j), with all digits.
std::string formula_of_table(std::string_view of_a, std::string_view of_b, const std::vector<double>& a,
                             const std::vector<double>& b, const std::vector<double>& values);

}  // namespace apsis
