#include <apsis/config/internal/key_table.hpp>
#include <apsis/model/mean_free_path.hpp>

#include <utility>

namespace apsis {
namespace {

std::vector<std::string> initial_choices(const case_config& c) {
  const model_entry* entry = try_find_model(c.model.name);
  return entry != nullptr ? initial_names(*entry) : std::vector<std::string>{};
}

/// Returns a key from which the resolver derives model.epsilon. A resolved case has it if
/// epsilon depends on x.
case_key derived_key(std::string path, case_key facts) {
  facts.scope = key_scope::velocity;
  facts.store = [](case_config&, const case_value&) {};
  facts.load = [path](const case_config& c) -> case_value {
    const epsilon_formula& given = c.model.epsilon;
    if (path == given.key) return given.text;
    if (path == "model.knudsen.mean_free_path" && !given.mean_free_path.empty()) return given.mean_free_path;
    return {};
  };
  facts.path = std::move(path);
  if (facts.type == key_type::formula) facts.unit = "dimensionless";
  return facts;
}

std::vector<case_key> model_keys() {
  return {key("title", [](auto& c) -> auto& { return c.title; },
              {.doc = "One line that says what the case shows."}),
          key("model.name", [](auto& c) -> auto& { return c.model.name; },
              {.required = true, .choices = names_in(model_entries), .doc = "The equation."}),
          key("model.epsilon", [](auto& c) -> auto& { return c.model.epsilon; },
              {.type = key_type::formula,
               .lowest = 0.0,
               .doc = "Knudsen number (relaxation time): a number, or a formula in the coordinates x, y, z "
                      "as text. 0 is the limit system."}),
          derived_key("model.knudsen",
                      {.doc = "In place of epsilon, for a gas with collision_rate = \"viscosity\": a table "
                              "{value, mean_free_path}, or \"from gas\", the default with a table [gas]."}),
          derived_key("model.knudsen.value",
                      {.type = key_type::formula,
                       .lowest = 0.0,
                       .doc = "Knudsen number lambda/L at rho = T = 1, a number or a formula as epsilon."}),
          derived_key("model.knudsen.mean_free_path",
                      {.choices = [](const case_config&) { return mean_free_path_names(); },
                       .doc = "Definition of lambda (docs/scales.md)."}),
          derived_key("model.rarefaction",
                      {.type = key_type::formula,
                       .lowest = 0.0,
                       .lowest_excluded = true,
                       .doc = "In place of epsilon, for a gas with collision_rate = \"viscosity\": the "
                              "rarefaction parameter delta = p L/(mu sqrt(2 R T)) = 1/(sqrt(2) epsilon) at "
                              "rho = T = 1, a number or a formula as epsilon."}),
          key("model.initial", [](auto& c) -> auto& { return c.model.initial; },
              {.choices = initial_choices,
               .doc = "Name of one of the model's initial data; the first of the model where not given."})};
}

}  // namespace

extern const key_table_entry key_table_model;
const key_table_entry key_table_model = {.place = 10, .keys = model_keys};

}  // namespace apsis
