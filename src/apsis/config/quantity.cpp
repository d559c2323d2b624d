// UDUNITS is not used because it reads "pa" as pico-years, and its values of u and Torr are older. It also
// needs files at run time (docs/measured.md, "Machinery that a library could replace").
#include <apsis/config/quantity.hpp>

#include <apsis/config/case_text.hpp>
#include <apsis/core/suggest.hpp>

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

struct unit_symbol {
  std::string_view name;
  double factor;  ///< in base units
  dimension unit;
};

// The torr is 101325/760 Pa, the atomic mass unit that of CODATA 2018.
constexpr std::array<unit_symbol, 12> symbols = {
    {{"m", 1.0, dimensions::length},
     {"g", 1e-3, dimensions::mass},
     {"u", 1.66053906660e-27, dimensions::mass},
     {"s", 1.0, dimensions::time},
     {"K", 1.0, dimensions::temperature},
     {"Pa", 1.0, dimensions::pressure},
     {"bar", 1e5, dimensions::pressure},
     {"atm", 101325.0, dimensions::pressure},
     {"Torr", 101325.0 / 760.0, dimensions::pressure},
     {"N", 1.0, dimensions::pressure* dimensions::length* dimensions::length},
     {"J", 1.0, dimensions::pressure* dimensions::length* dimensions::length* dimensions::length},
     {"W", 1.0, dimensions::heat_flux* dimensions::length* dimensions::length}}};

struct unit_prefix {
  std::string_view name;
  double factor;
};

constexpr std::array<unit_prefix, 10> prefixes = {{{"p", 1e-12},
                                                   {"n", 1e-9},
                                                   {"u", 1e-6},
                                                   {"\u00b5", 1e-6},
                                                   {"\u03bc", 1e-6},
                                                   {"m", 1e-3},
                                                   {"c", 1e-2},
                                                   {"h", 1e2},
                                                   {"k", 1e3},
                                                   {"M", 1e6}}};

bool is_celsius(std::string_view unit) {
  return unit == "degC" || unit == "\u00b0C";
}

/// Returns whether a byte belongs to a symbol. Bytes beyond ASCII are letters of units.
bool in_symbol(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 128;
}

/// Parses products and quotients of powers of symbols: "kg m^-3", "W/(m^2 K)".
class unit_parser {
 public:
  unit_parser(std::string_view text, const source_place& place) : text_(text), place_(place) {}

  quantity parse() {
    quantity all = product(0);
    if (at_ < text_.size()) refuse();
    return all;
  }

 private:
  static constexpr int deepest = 8;  // levels of parentheses

  quantity product(int depth) {
    quantity all = power(depth);
    for (;;) {
      const bool spaces = skip_spaces();
      if (at_ == text_.size() || text_[at_] == ')') return all;
      const bool divide = text_[at_] == '/';
      if (divide || text_[at_] == '*')
        ++at_;
      else if (!spaces)
        refuse();
      skip_spaces();
      const quantity next = power(depth);
      all.value = divide ? all.value / next.value : all.value * next.value;
      all.unit = bounded(divide ? all.unit / next.unit : all.unit * next.unit);
    }
  }

  quantity power(int depth) {
    const quantity base = factor(depth);
    if (at_ == text_.size() || text_[at_] != '^') return base;
    int exponent = 0;
    const char* end = text_.data() + text_.size();
    const auto [stop, problem] = std::from_chars(text_.data() + at_ + 1, end, exponent);
    if (problem != std::errc() || std::abs(exponent) > 9) refuse();
    at_ = static_cast<std::size_t>(stop - text_.data());
    quantity all{1.0, {}};
    for (int k = 0; k < std::abs(exponent); ++k) {
      all.value = exponent > 0 ? all.value * base.value : all.value / base.value;
      all.unit = bounded(exponent > 0 ? all.unit * base.unit : all.unit / base.unit);
    }
    return all;
  }

  quantity factor(int depth) {
    if (at_ < text_.size() && text_[at_] == '(' && depth < deepest) {
      ++at_;
      const quantity inner = product(depth + 1);
      if (at_ == text_.size()) refuse();
      ++at_;
      return inner;
    }
    if (at_ < text_.size() && text_[at_] == '1') {
      ++at_;
      return {1.0, {}};
    }
    std::size_t end = at_;
    while (end < text_.size() && in_symbol(text_[end])) ++end;
    const std::string_view name = text_.substr(at_, end - at_);
    if (name.empty()) refuse();
    at_ = end;
    return symbol(name);
  }

  quantity symbol(std::string_view name) const {
    for (const auto& one : symbols)
      if (one.name == name) return {one.factor, one.unit};
    for (const auto& prefix : prefixes)
      if (name.substr(0, prefix.name.size()) == prefix.name)
        for (const auto& one : symbols)
          if (one.name == name.substr(prefix.name.size())) return {prefix.factor * one.factor, one.unit};
    refuse_symbol(name);
  }

  [[noreturn]] void refuse_symbol(std::string_view name) const {
    if (name == "deg" || name == "\u00b0")
      throw input_error(place_,
                        fmt::format("unknown unit '{}' (angles are in degrees and have no unit); write "
                                    "the number alone",
                                    name));
    if (is_celsius(name))
      throw input_error(place_,
                        "degC is part of a unit (its zero is not that of K); give the temperature in K");
    std::vector<std::string> known;
    for (const auto& one : symbols) known.emplace_back(one.name);
    known.emplace_back("degC");
    throw input_error(
        place_, fmt::format("unknown unit '{}' (no such symbol, with or without a prefix); {}", shown(name),
                            suggest(name == "C" ? "degC" : std::string(name), known)));
  }

  /// Refuses exponents that no unit has. Larger ones would overflow in nested powers.
  dimension bounded(const dimension& d) const {
    for (const int exponent : {d.mass, d.length, d.time, d.temperature})
      if (std::abs(exponent) > 99) refuse();
    return d;
  }

  bool skip_spaces() {
    const std::size_t before = at_;
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return at_ > before;
  }

  [[noreturn]] void refuse() const {
    throw input_error(place_, fmt::format("'{}' is not a unit (products, quotients and powers of symbols are "
                                          "expected); write for example kg/m^3",
                                          shown(text_)));
  }

  std::string_view text_;
  const source_place& place_;
  std::size_t at_ = 0;
};

struct number_and_unit {
  double number = 0.0;
  std::string_view unit;  ///< "" if the text is not of this form
};

bool is_percent(std::string_view unit) {
  return unit == "%";
}

number_and_unit split(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  number_and_unit parts;
  const char *begin = text.data(), *end = begin + text.size();
  const auto [stop, problem] = std::from_chars(begin, end, parts.number);
  if (problem != std::errc() || !std::isfinite(parts.number)) return {};
  text.remove_prefix(static_cast<std::size_t>(stop - begin));
  if (text.empty() || (text.front() != ' ' && !is_percent(text))) return {};
  while (text.front() == ' ') text.remove_prefix(1);
  if (in_symbol(text.front()) || text.front() == '1' || text.front() == '(' || is_percent(text))
    parts.unit = text;
  return parts;
}

}  // namespace

bool looks_like_quantity(const std::string& text) {
  return !split(text).unit.empty();
}

std::string with_missing_space(const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, number);
  if (problem != std::errc() || stop == end || !in_symbol(*stop)) return "";
  const auto length = static_cast<std::size_t>(stop - text.data());
  std::string spaced = text.substr(0, length) + " " + text.substr(length);
  try {
    parse_quantity(spaced, {});
  } catch (const input_error&) {
    return "";  // a formula, whose own message is better
  }
  return spaced;
}

quantity parse_quantity(const std::string& text, const source_place& place) {
  const auto [number, unit] = split(text);
  if (unit.empty())
    throw input_error(place, fmt::format("'{}' is not a quantity (a number, a space and a unit are needed); "
                                         "write for example \"10 Pa\"",
                                         shown(text)));
  if (is_percent(unit))
    throw input_error(place, fmt::format("'{}' is a percentage (a share is a number from 0 to 1); write {:g}",
                                         shown(text), number / 100.0));
  quantity all = is_celsius(unit) ? quantity{number + 273.15, dimensions::temperature}
                                  : unit_parser(unit, place).parse();
  if (!is_celsius(unit)) all.value *= number;
  if (!std::isfinite(all.value))
    throw input_error(place,
                      fmt::format("'{}' is not finite (in SI units); give a finite number", shown(text)));
  return all;
}

}  // namespace apsis
