#include <apsis/study/vary.hpp>

#include <apsis/config/case_text.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/method/time_integrator.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Returns the parts of a list between commas, without space around them. Commas inside brackets, braces and
/// quotes belong to a value.
std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  char quote = '\0';
  for (const char c : text) {
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{' || c == '(') {
      ++depth;
    } else if (c == ']' || c == '}' || c == ')') {
      --depth;
    }
    if (c == ',' && depth <= 0 && quote == '\0')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  for (std::string& part : parts) {
    const auto first = part.find_first_not_of(" \t"), last = part.find_last_not_of(" \t");
    part = first == std::string::npos ? "" : part.substr(first, last - first + 1);
  }
  return parts;
}

/// A number in its notation: an integer, a fraction of integers, or a decimal.
struct written_number {
  double value;
  std::optional<long> above, below;  ///< numerator and denominator of an integer or a fraction

  static std::optional<written_number> read(const std::string& text) {
    const auto slash = text.find('/');
    const auto above = parse<double>(text.substr(0, slash));
    const auto below = slash == std::string::npos ? 1.0 : parse<double>(text.substr(slash + 1));
    if (!above || !below || !(*above > 0.0) || !(*below > 0.0)) return std::nullopt;
    const auto integer = parse<long>(text.substr(0, slash));
    return written_number{*above / *below, integer,
                          slash == std::string::npos ? 1 : parse<long>(text.substr(slash + 1))};
  }

  /// Returns the number times 2^k, in the same notation if possible.
  std::string scaled(int k) const {
    constexpr long small = 1L << 31;
    if (!above || !below || *above > small || *below > small || std::abs(k) > 30)
      return fmt::format("{}", std::ldexp(value, k));
    long p = *above, q = *below;
    for (; k > 0; --k) q % 2 == 0 ? q /= 2 : p *= 2;
    for (; k < 0; ++k) p % 2 == 0 ? p /= 2 : q *= 2;
    return q == 1 ? fmt::format("{}", p) : fmt::format("{}/{}", p, q);
  }

 private:
  template <class T>
  static std::optional<T> parse(const std::string& text) {
    T x{};
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return x;
  }
};

[[noreturn]] void refuse_vary(const std::string& text, const std::string& problem,
                              const std::string& advice) {
  throw input_error(fmt::format("--vary '{}': {}; {}", shown(text), problem, advice));
}

/// Returns the values of "a..b"; empty if the text is not a range of numbers.
std::vector<std::string> range(const std::string& value, const std::string& vary) {
  const auto dots = value.find("..");
  if (dots == std::string::npos) return {};
  const auto first = written_number::read(value.substr(0, dots));
  const auto last = written_number::read(value.substr(dots + 2));
  if (!first || !last) return {};
  const double doublings = std::log2(last->value / first->value);
  const int count = std::abs(doublings) < 100.0 ? static_cast<int>(std::lround(doublings)) : 0;
  if (!(std::abs(doublings - count) <= 1e-9))
    refuse_vary(vary, fmt::format("the range {} does not end (doubling or halving misses its end)", value),
                "list the values");
  std::vector<std::string> values;
  for (int k = 0; k <= std::abs(count); ++k) values.push_back(first->scaled(count < 0 ? -k : k));
  return values;
}

}  // namespace

varied_key parse_vary(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    refuse_vary(text, "not of the form key=value,value,… (a key and its values are needed)",
                "write for example space.cells=20,40,80");
  varied_key varied{text.substr(0, equals), {}};
  for (const auto& value : split(text.substr(equals + 1))) {
    if (value.empty())
      refuse_vary(text, "a value is empty (nothing precedes or follows a comma, or follows =)",
                  "write for example space.cells=20,40,80");
    const auto many = range(value, text);
    for (const auto& one : many.empty() ? std::vector<std::string>{value} : many) {
      if (std::find(varied.values.begin(), varied.values.end(), one) != varied.values.end())
        refuse_vary(text, fmt::format("the value {} occurs twice (each value makes a run)", shown(one)),
                    "remove one");
      varied.values.push_back(one);
    }
  }
  return varied;
}

convergence_reference parse_reference(const std::string& text) {
  using kind = convergence_reference::kind;
  const std::vector<std::pair<std::string, kind>> words = {
      {"exact", kind::exact}, {"next", kind::next}, {"time", kind::time}, {"space+time", kind::space_time}};
  for (const auto& [word, how] : words)
    if (text == word) return {how, {}};
  const auto at = text.find('@'), equals = text.find('=');
  if (at != std::string::npos && equals == std::string::npos) {
    static_cast<void>(find_integrator(text.substr(0, at)));
    return {kind::given, {"time.method=" + text.substr(0, at), "time.dt=" + text.substr(at + 1)}};
  }
  if (equals != std::string::npos) return {kind::given, split(text)};
  std::vector<std::string> names;
  for (const auto& item : words) names.push_back(item.first);
  names.emplace_back("METHOD@STEP");
  names.emplace_back("key=value,...");
  throw input_error(fmt::format("no reference '{}' (a word, a method and its step, or keys of the case); {}",
                                shown(text), suggest(text, names)));
}

}  // namespace apsis
