#pragma once

#include <CLI/CLI.hpp>

namespace apsis::app {

/// Adds checks to every option and argument that takes a value, before its own checks: no empty value, no
/// text that begins with '-' (an option in place of a value), only finite numbers, only whole integers ("1e3"
/// is 1000). Parsing then throws an input_error that names the option.
void check_option_values(CLI::App& program);

/// Validator for numbers above 0.
CLI::Validator positive_number();

}  // namespace apsis::app
