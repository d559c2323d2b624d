#include <apsis/study/model_cases.hpp>

#include <apsis/config/discretization_of_case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/study/model_properties.hpp>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr int cells = 16, steps = 8;
constexpr double length = 2.0, velocity_max = 12.0;

}  // namespace

case_config small_case(const std::string& model, const std::vector<std::string>& overrides) {
  const model_entry* entry = try_find_model(model);
  if (entry == nullptr) throw input_error("unknown model '" + model + "'");
  std::string text = fmt::format("[model]\nname = \"{}\"\n", model);
  double dt = 1.0 / 32.0;
  if (has_space(*entry)) {
    text += fmt::format("[space]\ncells = {}\ndomain = [0.0, {:.1f}]\n", cells, length);
    dt = 0.5 * length / cells / (entry->has_velocity_grid ? velocity_max : 1.0);
  }
  if (entry->has_velocity_grid) text += fmt::format("[velocity]\nmax = {:.1f}\npoints = 60\n", velocity_max);
  text += fmt::format("[time]\nmethod = \"md-imex-6-3\"\ndt = {:.17g}\nend = {:.17g}\n", dt, steps * dt);
  return parse_case(text, "small case of model " + model, overrides);
}

std::vector<std::string> relaxation_model_names() {
  std::vector<std::string> names;
  for (const auto& m : all_models())
    if (m.relaxation != nullptr) names.push_back(m.entry->name);
  return names;
}

std::vector<std::string> formulation_names(const std::string& model) {
  if (!has_space(find_model(model))) return {""};
  return {"finite-volume", "finite-difference"};
}

std::vector<std::string> formulation_override(const std::string& discretization) {
  if (discretization.empty()) return {};
  return {discretization_override(discretization)};
}

}  // namespace apsis
