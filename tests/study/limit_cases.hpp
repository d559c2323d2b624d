#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/study/model_cases.hpp>

#include <string>
#include <vector>

/// Returns the IMEX methods that are asymptotic preserving from any data. Methods without GSA are so only in
/// their moments.
inline std::vector<std::string> preserving_methods() {
  std::vector<std::string> names;
  for (const auto& name : apsis::method_names()) {
    const auto& c = apsis::find_certificate(name);
    if (c.kind == apsis::method_kind::imex && c.type == "A") names.push_back(name);
  }
  return names;
}

inline apsis::case_config small_case(const std::string& model, const std::string& method,
                                     const std::string& formulation,
                                     std::vector<std::string> overrides = {}) {
  overrides.push_back("time.method=" + method);
  for (const auto& one : apsis::formulation_override(formulation)) overrides.push_back(one);
  return apsis::small_case(model, overrides);
}

/// Returns the values of a field without its padding.
inline std::vector<double> values(const apsis::field& u) {
  std::vector<double> all;
  for (int i = 0; i < u.cells(); ++i) all.insert(all.end(), u.row(i), u.row(i) + u.components());
  return all;
}
