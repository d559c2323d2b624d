#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace apsis::formula_language {

/// A function of formulas.
template <class Call>
struct function {
  const char* name;
  Call call;
};
using function_of_one = function<double (*)(double)>;
using function_of_two = function<double (*)(double, double)>;

/// All functions but tables. The built-in functions of muParser are not used, because `log` changed between
/// its versions.
inline constexpr std::array<function_of_one, 14> functions_of_one = {{{"sin", std::sin},
                                                                      {"cos", std::cos},
                                                                      {"tan", std::tan},
                                                                      {"asin", std::asin},
                                                                      {"acos", std::acos},
                                                                      {"atan", std::atan},
                                                                      {"sinh", std::sinh},
                                                                      {"cosh", std::cosh},
                                                                      {"tanh", std::tanh},
                                                                      {"exp", std::exp},
                                                                      {"log", std::log},
                                                                      {"log10", std::log10},
                                                                      {"sqrt", std::sqrt},
                                                                      {"abs", std::fabs}}};
inline constexpr std::array<function_of_two, 2> functions_of_two = {{{"min", std::fmin}, {"max", std::fmax}}};

/// A constant of formulas.
struct constant {
  const char* name;
  double value;
};
inline constexpr std::array<constant, 2> constants = {{{"pi", std::numbers::pi}, {"e", std::numbers::e}}};

/// Returns the names of constants, functions and tables.
const std::vector<std::string>& names();

}  // namespace apsis::formula_language
