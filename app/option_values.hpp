#pragma once

#include <CLI/CLI.hpp>

namespace apsis::app {

/// Adds checks to every option and argument of every command that takes a value, before its own: a value is
/// not empty, a text does not begin with '-' (an option in its place), a number is finite and an integer is
/// whole
/// ("1e3" is 1000). Parsing then throws input_error with the name of the option.
void check_option_values(CLI::App& program);

/// A number above 0, for options of which it is not enough that they are finite.
CLI::Validator positive_number();

}  // namespace apsis::app
