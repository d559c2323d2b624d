#pragma once

#include <apsis/core/embedded.hpp>
#include <apsis/method/intermediate_regime.hpp>
#include <apsis/method/method.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

/// Returns the one-step methods of the catalogue, parsed once and not certified.
inline const std::vector<apsis::method>& parsed_methods() {
  static const auto all = [] {
    std::vector<apsis::method> methods;
    for (const auto& file : apsis::embedded::methods())
      methods.push_back(apsis::parse_any_method(file.text, std::string(file.name)));
    std::erase_if(methods, [](const apsis::method& m) { return m.steps != 1; });
    return methods;
  }();
  return all;
}

/// Returns the one-step methods of the catalogue whose files satisfy a condition. Does not certify them,
/// because every process that runs a single test builds these lists.
template <class Condition>
std::vector<std::string> methods_where(const Condition& condition) {
  std::vector<std::string> names;
  for (const apsis::method& m : parsed_methods())
    if (condition(m)) names.push_back(m.name);
  return names;
}

/// Returns true if a method has an SSP coefficient r > 0 at every ε. Explicit methods do not, because their
/// steps end at ε/C.
inline bool is_convex_at_every_epsilon(const apsis::method& m) {
  return m.kind == apsis::method_kind::imex && m.claims.ssp_coefficient.value_or("0") != "0";
}

/// Returns the methods with transport whose O(ε) terms follow from their coefficients.
inline std::vector<std::string> methods_with_an_intermediate_regime() {
  return methods_where([](const apsis::method& m) {
    return m.kind == apsis::method_kind::imex &&
           apsis::analyse_intermediate_regime(m.coefficients<double>()).applies;
  });
}

/// Returns a method name as a test name, without dashes.
inline std::string test_name(const testing::TestParamInfo<std::string>& method) {
  std::string name = method.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
