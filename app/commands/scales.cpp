#include "command_registry.hpp"
#include "print.hpp"
#include "scales_text.hpp"

#include <apsis/config/case_json.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/model/mean_free_path.hpp>
#include <apsis/output/json_text.hpp>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace scales_command {
namespace {

/// The command line of `apsis scales`.
struct scales_options {
  std::string case_name;
  std::vector<std::string> overrides;
  bool json = false;
};

/// Returns the constant ε of a case. Throws input_error if its model has no viscosity ε T^s, or ε(x) varies.
double constant_epsilon(const case_config& config) {
  const auto rate = config.model.options.find("collision_rate");
  if (rate == config.model.options.end() || rate->second != "viscosity")
    throw input_error(place_of(config, "model.epsilon"),
                      "the case has no viscosity epsilon T^s (a mean free path follows from it); add "
                      "collision_rate = \"viscosity\" or a table [gas]");
  const int dimensions = prototype(find_model(config.model.name)).space_dimensions();
  const expression formula = make_epsilon(config, dimensions);
  if (!formula.is_constant())
    throw input_error(place_of(config, "model.epsilon"),
                      "epsilon depends on the position (there is no single Knudsen number); give a number");
  return formula.evaluate(std::array<double, 3>{});
}

nlohmann::ordered_json json_of(double epsilon, double exponent) {
  nlohmann::ordered_json out = {{"epsilon", epsilon}, {"rarefaction", rarefaction_of_epsilon(epsilon)}};
  for (const auto& one : mean_free_paths())
    out["knudsen_" + one.name] = one.knudsen_of_epsilon(exponent) * epsilon;
  return out;
}

int scales(const scales_options& options) {
  const case_config config = load_case(options.case_name, options.overrides);
  const double epsilon = constant_epsilon(config);
  const double exponent = config.model.parameters.at("viscosity_exponent");
  if (options.json)
    print(json_text(config.scales ? to_json(*config.scales) : json_of(epsilon, exponent)) + "\n");
  else
    print((config.scales ? scales_text(*config.scales) : "") + knudsen_text(epsilon, exponent));
  return 0;
}

action define(CLI::App& command) {
  auto options = std::make_shared<scales_options>();
  command
      .add_option("CASE", options->case_name,
                  "a case file, or the name of a built-in case (apsis list cases)")
      ->required();
  command.add_option("key=value", options->overrides, "override key=value of the case (apsis show case)");
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return scales(*options); };
}

}  // namespace
}  // namespace scales_command

extern const command_entry command_scales;
const command_entry command_scales = {
    .name = "scales",
    .summary = "Knudsen numbers of a case in every definition, and its units by the table [gas]",
    .place = 45,
    .completion = completed_from_list("cases"),
    .define = scales_command::define};

}  // namespace apsis::app
