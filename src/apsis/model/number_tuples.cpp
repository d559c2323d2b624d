#include <apsis/model/number_tuples.hpp>

#include <cstddef>

namespace apsis {
namespace {

/// Splits a text at commas outside parentheses.
std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (const char c : text) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && depth == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

}  // namespace

std::vector<std::vector<double>> number_tuples(const std::vector<std::string>& texts,
                                               const formula_constants& constants) {
  std::vector<std::vector<double>> tuples;
  for (const auto& text : texts) {
    auto& numbers = tuples.emplace_back();
    for (const auto& part : parts_of(text))
      numbers.push_back(
          expression(part, {}, formula_kind{{}, false, constants}).evaluate(std::span<const double>{}));
  }
  return tuples;
}

}  // namespace apsis
