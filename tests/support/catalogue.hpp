#pragma once

#include <apsis/core/embedded.hpp>
#include <apsis/method/intermediate_regime.hpp>
#include <apsis/method/method.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

/// Methods of the catalogue by what their files say. Nothing is certified: these lists are made in every
/// process that runs a single test.
template <class Condition>
std::vector<std::string> methods_where(const Condition& condition) {
  std::vector<std::string> names;
  for (const auto& file : apsis::embedded::methods())
    if (condition(apsis::parse_method(file.text, std::string(file.name)))) names.emplace_back(file.name);
  return names;
}

/// Methods with transport whose terms of size ε can be told from the coefficients.
inline std::vector<std::string> methods_with_an_intermediate_regime() {
  return methods_where([](const apsis::method& m) {
    return m.kind == apsis::method_kind::imex &&
           apsis::analyse_intermediate_regime(m.coefficients<double>()).applies;
  });
}

/// The name of a method as that of a test, which may not have dashes.
inline std::string test_name(const testing::TestParamInfo<std::string>& method) {
  std::string name = method.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
