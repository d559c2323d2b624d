#pragma once

#include <apsis/core/embedded.hpp>
#include <apsis/method/method.hpp>

#include <string>
#include <vector>

/// Methods of the catalogue by what their files say. Nothing is certified: these lists are made in every
/// process that runs a single test.
template <class Condition>
std::vector<std::string> methods_where(const Condition& condition) {
  std::vector<std::string> names;
  for (const auto& file : apsis::embedded::methods())
    if (condition(apsis::parse_method(file.text, std::string(file.name)))) names.emplace_back(file.name);
  return names;
}
