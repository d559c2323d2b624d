#include <apsis/config/steady_of_case.hpp>

#include <apsis/mesh/face.hpp>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Returns whether a formula contains the name t, which no constant can have.
bool contains_time(const std::string& formula) {
  const auto of_a_name = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  };
  for (std::size_t k = 0; k < formula.size(); ++k)
    if (formula[k] == 't' && (k == 0 || !of_a_name(formula[k - 1])) &&
        (k + 1 == formula.size() || !of_a_name(formula[k + 1])))
      return true;
  return false;
}

void check_formulas(const case_config& config, const std::string& path,
                    const std::vector<std::string>& formulas) {
  if (std::any_of(formulas.begin(), formulas.end(), contains_time))
    throw input_error(place_of(config, path),
                      fmt::format("'{}' depends on t (a steady state has no time); remove t, or the table "
                                  "[steady]",
                                  path));
}

void check_values(const case_config& config, const std::string& table, const state_formulas& values) {
  for (const auto& [name, formulas] : values)
    check_formulas(config, fmt::format("{}.{}", table, name), formulas);
}

}  // namespace

void check_steady(const case_config& config, const model& equation) {
  if (equation.as_relaxation() == nullptr)
    throw input_error(place_of(config, "model.name"),
                      fmt::format("model '{}' has no steady solver (it does not relax to an equilibrium of "
                                  "its moments); march in time with a table [time]",
                                  config.model.name));
  for (std::size_t k = 0; k < config.faces.size(); ++k)
    check_values(config, "boundary." + face_names[k], config.faces[k].values);
  for (std::size_t k = 0; k < config.solids.size(); ++k)
    check_values(config, fmt::format("space.solid.{}", k + 1), config.solids[k].values);
  for (std::size_t k = 0; k < config.bodies.size(); ++k)
    check_values(config, fmt::format("space.body.{}", k + 1), config.bodies[k].values);
  if (config.force.acceleration) check_formulas(config, "force.acceleration", *config.force.acceleration);
  check_values(config, "source", config.source_term);
}

}  // namespace apsis
