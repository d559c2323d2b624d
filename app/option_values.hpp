#pragma once

#include <CLI/CLI.hpp>

namespace apsis::app {

/// Adds checks to every option and argument that takes a value, before its own checks. Texts must not be
/// empty or begin with '-', as an option in place of a value does. Numbers must be finite, and integers whole
/// ("1e3" is 1000). Parsing then throws an input_error that names the option.
void check_option_values(CLI::App& program);

/// Returns a validator for numbers above 0.
CLI::Validator positive_number();

}  // namespace apsis::app
