#include <apsis/model/formula_table.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

constexpr std::string_view word_of_one = "table", word_of_two = "table2";

bool of_a_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::size_t after_blanks(const std::string& text, std::size_t at) {
  while (at < text.size() && (text[at] == ' ' || text[at] == '\t')) ++at;
  return at;
}

/// A call of a table in a formula.
struct table_word {
  std::size_t at = std::string::npos;  ///< npos if there is no call
  bool of_two = false;

  std::string_view text() const { return of_two ? word_of_two : word_of_one; }
  std::size_t end() const { return at + text().size(); }
  std::string advice() const {
    return of_two ? "write for example table2(x, y, 2, 0, 1, 0, 5, 6, 1, 7, 8)"
                  : "write for example table(t, 0, 1, 0.5, 2)";
  }
};

/// Returns the first position from `at` on where "table" or "table2" is a whole word.
table_word find_word(const std::string& text, std::size_t at) {
  for (at = text.find(word_of_one, at); at != std::string::npos; at = text.find(word_of_one, at + 1)) {
    const table_word found{at, text.compare(at, word_of_two.size(), word_of_two) == 0};
    const std::size_t end = found.end();
    if ((at == 0 || !of_a_name(text[at - 1])) && (end == text.size() || !of_a_name(text[end]))) return found;
  }
  return {};
}

/// Returns the comma behind the argument that begins at `at`; npos without a comma.
std::size_t end_of_argument(const std::string& text, std::size_t at) {
  for (int depth = 0; at < text.size(); ++at) {
    if (text[at] == '(') ++depth;
    if (text[at] == ')' && --depth < 0) break;
    if (text[at] == ',' && depth == 0) return at;
  }
  return std::string::npos;
}

class reader_of_points {
 public:
  using failure = std::function<void(std::size_t, const std::string&, const std::string&)>;

  reader_of_points(const std::string& text, const table_word& call, const failure& fail)
      : text_(text), call_(call), fail_(fail) {}

  /// Reads ", a_1, v_1, …)" or ", n, a_1, …)" from a comma on. end() is then the closing parenthesis.
  formula_table read(std::size_t comma) {
    read_numbers(comma);
    return call_.of_two ? of_two() : of_one();
  }
  std::size_t end() const { return at_; }

 private:
  void read_numbers(std::size_t comma) {
    for (at_ = comma; at_ < text_.size() && text_[at_] == ',';) {
      places_.push_back(after_blanks(text_, at_ + 1));
      numbers_.push_back(number(places_.back()));
      if (numbers_.size() > 2 * formula_table::most_points)
        fail_(places_.back(), fmt::format("a table has more than {} points", formula_table::most_points),
              "give fewer points");
    }
    if (at_ >= text_.size() || text_[at_] != ')')
      fail_(std::min(at_, text_.size() - 1), "a table does not end here", call_.advice());
  }

  double number(std::size_t begin) {
    const std::size_t sign = begin < text_.size() && text_[begin] == '+' ? 1 : 0;
    double value = 0.0;
    const auto [stop, problem] = std::from_chars(text_.data() + std::min(begin + sign, text_.size()),
                                                 text_.data() + text_.size(), value);
    if (problem != std::errc() || !std::isfinite(value))
      fail_(std::min(begin, text_.size() - 1), "a point of a table is not a finite number", call_.advice());
    at_ = after_blanks(text_, static_cast<std::size_t>(stop - text_.data()));
    return value;
  }

  /// Checks that number k is larger than an earlier one.
  void check_order(std::size_t k, std::size_t earlier) const {
    if (!(numbers_[k] > numbers_[earlier]))
      fail_(places_[k], "arguments of a table do not increase", "sort its points");
  }

  formula_table of_one() const {
    std::vector<std::pair<double, double>> points;
    for (std::size_t k = 0; k < numbers_.size(); k += 2) {
      if (k > 0) check_order(k, k - 2);
      if (k + 1 == numbers_.size()) fail_(at_, "the last point of a table has no value", call_.advice());
      points.emplace_back(numbers_[k], numbers_[k + 1]);
    }
    return formula_table(points);
  }

  formula_table of_two() const {
    const double given = numbers_.front();
    const auto rest = static_cast<double>(numbers_.size() - 1);
    if (!(given >= 1.0 && given <= rest) || given != std::floor(given))
      fail_(places_.front(), "this is not the number of the first arguments of a table", call_.advice());
    const auto n = static_cast<std::size_t>(given);
    if (numbers_.size() < 2 * n + 2 || (numbers_.size() - 1 - n) % (n + 1) != 0)
      fail_(at_, fmt::format("the last row of a table has no {} values", n), call_.advice());
    const auto first = numbers_.begin() + 1;
    std::vector<double> a(first, first + static_cast<std::ptrdiff_t>(n)), b, values;
    for (std::size_t k = 2; k <= n; ++k) check_order(k, k - 1);
    for (std::size_t row = n + 1; row < numbers_.size(); row += n + 1) {
      if (!b.empty()) check_order(row, row - n - 1);
      b.push_back(numbers_[row]);
      for (std::size_t k = 1; k <= n; ++k) values.push_back(numbers_[row + k]);
    }
    return {std::move(a), std::move(b), std::move(values)};
  }

  const std::string& text_;
  table_word call_;
  const failure& fail_;
  std::size_t at_ = 0;
  std::vector<double> numbers_;
  std::vector<std::size_t> places_;  ///< positions of the numbers in the text
};

/// Returns the index of the last point at or before x, and the share of the next point in the interpolation.
/// Outside the points the share is 0.
std::pair<std::size_t, double> locate(const std::vector<double>& points, double x) {
  const auto after = std::upper_bound(points.begin(), points.end(), x);
  if (after == points.begin()) return {0, 0.0};
  const auto k = static_cast<std::size_t>(after - points.begin()) - 1;
  return {k, after == points.end() ? 0.0 : (x - points[k]) / (points[k + 1] - points[k])};
}

/// Interpolates linearly between v_0 and v_1. Does not evaluate v_1 if its share is 0.
template <class Value>
double between(double share, const Value& value) {
  return share == 0.0 ? value(0) : (1.0 - share) * value(0) + share * value(1);
}

}  // namespace

formula_table::formula_table(const std::vector<std::pair<double, double>>& points) {
  for (const auto& [a, v] : points) {
    a_.push_back(a);
    values_.push_back(v);
  }
}

double formula_table::at(double a, double b) const {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::quiet_NaN();
  const auto column = locate(a_, a), row = b_.empty() ? std::pair{std::size_t{0}, 0.0} : locate(b_, b);
  const auto in_row = [&](std::size_t j) {
    const double* values = values_.data() + (row.first + j) * a_.size() + column.first;
    return between(column.second, [values](std::size_t i) { return values[i]; });
  };
  return between(row.second, in_row);
}

text_of_tables take_tables(const std::string& formula, const reader_of_points::failure& fail) {
  text_of_tables out;
  out.text = formula;
  std::vector<std::pair<std::size_t, std::size_t>> removed;
  for (table_word call = find_word(formula, 0); call.at != std::string::npos;
       call = find_word(formula, call.at + 1)) {
    const std::size_t open = after_blanks(formula, call.end());
    const bool called = open < formula.size() && formula[open] == '(';
    std::size_t comma = called ? end_of_argument(formula, open + 1) : std::string::npos;
    if (call.of_two && comma != std::string::npos) comma = end_of_argument(formula, comma + 1);
    if (comma == std::string::npos) fail(call.at, "a table without points", call.advice());
    if (out.tables.size() == most_tables)
      fail(call.at, fmt::format("more than {} tables", most_tables), "write fewer");
    reader_of_points points(formula, call, fail);
    // The name has the length of the word, so that positions in the text stay valid. Names of users begin
    // with a letter and cannot be equal to it.
    out.names.push_back(fmt::format("{}{:02}", call.of_two ? "_t2_" : "_t_", out.tables.size()));
    out.text.replace(call.at, call.text().size(), out.names.back());
    out.tables.push_back(points.read(comma));
    removed.emplace_back(comma, points.end());
  }
  std::sort(removed.begin(), removed.end());
  std::size_t done = 0;  // characters of the formula that are copied or removed
  std::string shorter;
  for (const auto& [begin, end] : removed) {
    shorter.append(out.text, done, begin - done);
    out.cuts.emplace_back(shorter.size(), end - begin);
    done = end;
  }
  out.text = shorter.append(out.text, done, std::string::npos);
  return out;
}

std::string formula_of_table(std::string_view argument,
                             const std::vector<std::pair<double, double>>& points) {
  std::vector<std::string> texts;
  texts.reserve(points.size());
  for (const auto& [a, v] : points) texts.push_back(fmt::format("{}, {}", a, v));
  return fmt::format("{}({}, {})", word_of_one, argument, fmt::join(texts, ", "));
}

std::string formula_of_table(std::string_view of_a, std::string_view of_b, const std::vector<double>& a,
                             const std::vector<double>& b, const std::vector<double>& values) {
  std::vector<std::string> rows;
  rows.reserve(b.size());
  for (std::size_t j = 0; j < b.size(); ++j) {
    const double* row = values.data() + j * a.size();
    rows.push_back(fmt::format("{}, {}", b[j], fmt::join(row, row + a.size(), ", ")));
  }
  return fmt::format("{}({}, {}, {}, {}, {})", word_of_two, of_a, of_b, a.size(), fmt::join(a, ", "),
                     fmt::join(rows, ", "));
}

}  // namespace apsis
