#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace apsis::app {

/// Throws input_error if the first argument is neither a command nor an option.
void check_first_argument(const std::string& first, const std::vector<std::string>& names);

/// Throws input_error with what CLI11 did not understand, and with a suggestion.
[[noreturn]] void refuse_usage(const CLI::App& program, const CLI::ParseError& problem);

}  // namespace apsis::app
