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

constexpr std::string_view word = "table";
const std::string advice_of_tables = "write for example table(t, 0, 1, 0.5, 2)";

bool of_a_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::size_t after_blanks(const std::string& text, std::size_t at) {
  while (at < text.size() && (text[at] == ' ' || text[at] == '\t')) ++at;
  return at;
}

/// Returns where the word stands alone, from `at` on; npos without one.
std::size_t find_word(const std::string& text, std::size_t at) {
  for (at = text.find(word, at); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !of_a_name(text[at - 1])) && (end == text.size() || !of_a_name(text[end]))) return at;
  }
  return at;
}

/// Returns the comma after the first argument that begins at `at`; npos without one.
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

  reader_of_points(const std::string& text, const failure& fail) : text_(text), fail_(fail) {}

  /// Reads ", a_0, v_0, …)" from a comma on; end() is the parenthesis.
  std::vector<std::pair<double, double>> read(std::size_t comma) {
    std::vector<double> numbers;
    for (at_ = comma; at_ < text_.size() && text_[at_] == ',';) {
      const std::size_t begin = after_blanks(text_, at_ + 1);
      numbers.push_back(number(begin));
      const std::size_t n = numbers.size();
      if (n % 2 == 1 && n > 2 && !(numbers[n - 1] > numbers[n - 3]))
        fail_(begin, "arguments of a table do not increase", "sort its points");
      if (n > 2 * formula_table::most_points)
        fail_(begin, fmt::format("a table has more than {} points", formula_table::most_points),
              "give fewer points");
    }
    if (at_ >= text_.size() || text_[at_] != ')')
      fail_(std::min(at_, text_.size() - 1), "a table does not end here", advice_of_tables);
    if (numbers.size() % 2 == 1) fail_(at_, "the last point of a table has no value", advice_of_tables);
    std::vector<std::pair<double, double>> points;
    for (std::size_t k = 0; k < numbers.size(); k += 2) points.emplace_back(numbers[k], numbers[k + 1]);
    return points;
  }
  std::size_t end() const { return at_; }

 private:
  double number(std::size_t begin) {
    const std::size_t sign = begin < text_.size() && text_[begin] == '+' ? 1 : 0;
    double value = 0.0;
    const auto [stop, problem] = std::from_chars(text_.data() + std::min(begin + sign, text_.size()),
                                                 text_.data() + text_.size(), value);
    if (problem != std::errc() || !std::isfinite(value))
      fail_(std::min(begin, text_.size() - 1), "a point of a table is not a finite number", advice_of_tables);
    at_ = after_blanks(text_, static_cast<std::size_t>(stop - text_.data()));
    return value;
  }

  const std::string& text_;
  const failure& fail_;
  std::size_t at_ = 0;
};

}  // namespace

double formula_table::at(double a) const {
  if (std::isnan(a)) return a;
  const auto after = std::upper_bound(points_.begin(), points_.end(), a,
                                      [](double x, const auto& point) { return x < point.first; });
  if (after == points_.begin()) return points_.front().second;
  const auto& [a0, v0] = *(after - 1);
  if (after == points_.end()) return v0;
  const auto& [a1, v1] = *after;
  const double share = (a - a0) / (a1 - a0);
  return (1.0 - share) * v0 + share * v1;
}

std::string name_of_table(std::size_t k) {
  return fmt::format("_t_{:02}", k);  // as long as the word; names of users begin with a letter
}

text_of_tables take_tables(const std::string& formula, const reader_of_points::failure& fail) {
  text_of_tables out;
  std::size_t done = 0;  // characters of the formula that are in the text
  std::vector<std::pair<std::size_t, std::size_t>> removed;
  for (std::size_t at = find_word(formula, 0); at != std::string::npos; at = find_word(formula, at + 1)) {
    const std::size_t open = after_blanks(formula, at + word.size());
    const bool called = open < formula.size() && formula[open] == '(';
    const std::size_t comma = called ? end_of_argument(formula, open + 1) : std::string::npos;
    if (comma == std::string::npos) fail(at, "a table without points", advice_of_tables);
    if (out.tables.size() == most_tables)
      fail(at, fmt::format("more than {} tables", most_tables), "write fewer");
    reader_of_points points(formula, fail);
    out.tables.emplace_back(points.read(comma));
    removed.emplace_back(comma, points.end());
  }
  out.text = formula;
  std::size_t table = 0;
  for (std::size_t at = find_word(out.text, 0); at != std::string::npos; at = find_word(out.text, at + 1))
    out.text.replace(at, word.size(), name_of_table(table++));
  std::sort(removed.begin(), removed.end());
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
  return fmt::format("{}({}, {})", word, argument, fmt::join(texts, ", "));
}

}  // namespace apsis
