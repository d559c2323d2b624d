#include "option_values.hpp"

#include <apsis/core/errors.hpp>

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace apsis::app {
namespace {

enum class value_type { text, number, integer, unsigned_integer };

/// Returns the type of an option. CLI11 identifies it only by a name; the names of validators follow after
/// a colon.
value_type type_of(const CLI::Option& option) {
  const std::string full = option.get_type_name();
  const std::string name = full.substr(0, full.find(':'));
  if (name == "FLOAT") return value_type::number;
  if (name == "INT") return value_type::integer;
  return name == "UINT" ? value_type::unsigned_integer : value_type::text;
}

[[noreturn]] void refuse(const std::string& option, const std::string& given, const std::string& reason,
                         const std::string& suggestion) {
  throw input_error(
      fmt::format("command line: {} cannot be '{:.60}' ({}); {}", option, given, reason, suggestion));
}

template <class T>
std::optional<T> parse(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  T value{};
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string checked_number(const std::string& option, const std::string& given) {
  const auto value = parse<double>(given);
  if (!value || !std::isfinite(*value))
    refuse(option, given, "a finite decimal number is needed", "write for example 0.5 or 1e-3");
  return given;
}

/// Reads an integer in decimal digits, because CLI11 would read "010" as octal and wrap "-1" to an
/// unsigned value.
std::string checked_integer(const std::string& option, const std::string& given, bool sign) {
  if (const auto value = parse<long long>(given)) {
    if (!sign && *value < 0)
      refuse(option, given, "a number below 0 is not allowed here", "write for example 1");
    return std::to_string(*value);
  }
  if (!sign)
    if (const auto value = parse<unsigned long long>(given)) return std::to_string(*value);
  const auto value = parse<double>(given);
  // Up to 2^53 the double equals the written integer.
  if (value && std::isfinite(*value) && *value == std::floor(*value) && std::abs(*value) <= 0x1p53 &&
      (sign || *value >= 0.0))
    return fmt::format("{}", static_cast<long long>(*value));
  refuse(option, given, "an integer is needed", "write for example 10");
}

std::string checked_text(const CLI::Option& option, const std::string& name, const std::string& given) {
  if (given.empty()) refuse(name, given, "it is empty", "give a value");
  // After "--" an argument may begin with a dash; the value of an option may not, because it could be the
  // next option.
  if (!option.get_positional() && given.front() == '-')
    refuse(name, given, "it begins with a dash, as an option does",
           fmt::format("give {} a value; a path may begin with ./", name));
  return given;
}

std::string checked(const CLI::Option& option, const std::string& given) {
  const std::string name = option.get_positional() ? option.get_single_name() : option.get_name();
  switch (type_of(option)) {
    case value_type::number:
      return checked_number(name, given);
    case value_type::integer:
      return checked_integer(name, given, true);
    case value_type::unsigned_integer:
      return checked_integer(name, given, false);
    case value_type::text:
      break;
  }
  return checked_text(option, name, given);
}

}  // namespace

CLI::Validator positive_number() {
  return CLI::Validator(
      [](const std::string& given) {
        const auto value = parse<double>(given);
        return value && *value > 0.0 ? std::string()
                                     : fmt::format("a number above 0 is required, not {:.60}", given);
      },
      "POSITIVE");
}

void check_option_values(CLI::App& program) {
  for (CLI::App* command : program.get_subcommands({}))
    for (CLI::Option* option : command->get_options())
      if (option->get_items_expected_max() > 0)
        option->transform([option](const std::string& given) { return checked(*option, given); });
}

}  // namespace apsis::app
