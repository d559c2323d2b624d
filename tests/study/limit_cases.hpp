#pragma once

#include <apsis/config/case.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/run/setup.hpp>

#include <string>
#include <vector>

#include <fmt/format.h>

/// A small case made from nothing but the model's entry: first initial data, default parameters, four steps.
inline apsis::case_config small_case(const std::string& model, const std::string& method,
                                     const std::string& formulation,
                                     const std::vector<std::string>& overrides = {}) {
  const auto* entry = apsis::find_model(model);
  std::string text = fmt::format("[model]\nname = \"{}\"\n", model);
  if (entry->has_space)
    text += fmt::format("[space]\ncells = 16\ndomain = [0.0, 2.0]\nformulation = \"{}\"\n", formulation);
  if (entry->has_velocity) text += "[velocity]\nmax = 12.0\npoints = 60\n";
  text += fmt::format("[time]\nmethod = \"{}\"\nend = 0.02\ndt = 0.005\n", method);
  return apsis::parse_case(text, "a test", overrides);
}

/// Every relaxation model of the registry: one that is added tomorrow is tested by being there.
inline std::vector<std::string> relaxation_models() {
  std::vector<std::string> names;
  for (const auto* entry : apsis::model_entries()) {
    const apsis::run_setup setup(small_case(entry->name, "md-imex-3-2", "finite-volume"));
    if (dynamic_cast<const apsis::relaxation_model*>(setup.equation.get()) != nullptr)
      names.push_back(entry->name);
  }
  return names;
}

/// The IMEX methods that are asymptotic preserving from any data (any = true), or all the others.
inline std::vector<std::string> imex_methods(bool any) {
  std::vector<std::string> names;
  for (const auto& name : apsis::method_names()) {
    const auto& c = apsis::find_certificate(name);
    if (c.kind == apsis::method_kind::imex && (c.ap_data == "any data") == any) names.push_back(name);
  }
  return names;
}

/// "" for models without space.
inline std::vector<std::string> formulations(const std::string& model) {
  if (!apsis::find_model(model)->has_space) return {""};
  return {"finite-volume", "finite-difference"};
}

/// The values of a field without its padding.
inline std::vector<double> values(const apsis::field& u) {
  std::vector<double> all;
  for (int i = 0; i < u.cells(); ++i) all.insert(all.end(), u.row(i), u.row(i) + u.components());
  return all;
}
