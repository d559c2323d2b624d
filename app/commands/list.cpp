#include "command_registry.hpp"
#include "method_report.hpp"
#include "method_table.hpp"
#include "print.hpp"
#include "text_table.hpp"

#include <apsis/body/shape_registry.hpp>
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/case.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/method/family_registry.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/method_choice.hpp>
#include <apsis/method/step_law.hpp>
#include <apsis/method/time_integrator.hpp>
#include <apsis/model/gas_species.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/run/cfl_limit.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/semidiscrete/discretization_registry.hpp>

#include <map>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <paper/claim_registry.hpp>
#include <validation/quantity.hpp>

namespace apsis::app {
namespace list_command {
namespace {

using json = nlohmann::ordered_json;

json methods() {
  json all = json::array();
  for (const auto& name : method_names()) all.push_back(check_json(find_method(name)));
  return all;
}

json families() {
  json all = json::array();
  for (const family_entry* f : family_entries())
    all.push_back({{"name", f->pattern},
                   {"description", f->description},
                   {"lowest", f->lowest},
                   {"highest", f->highest}});
  return all;
}

json multistep() {
  json all = json::array();
  for (const auto& name : names_of_several_steps()) {
    const time_integrator& m = find_integrator(name);
    all.push_back({{"name", m.name},
                   {"description", m.title},
                   {"order", m.order},
                   {"steps", m.steps},
                   {"ssp_coefficient", m.ssp_coefficient},
                   {"cfl_limits", cfl_json(cfl_limits(m.growth()))},
                   {"stages", m.stages},
                   {"starter", m.starter().name}});
  }
  return all;
}

json models() {
  json all = json::array();
  for (const model_entry* m : model_entries()) {
    json parameters = json::array();
    for (const auto& p : m->parameters)
      parameters.push_back({{"name", p.name},
                            {"default", p.value},
                            {"lowest", p.lowest},
                            {"highest", p.highest},
                            {"automatic", p.automatic},
                            {"doc", p.doc}});
    json lists = json::array();
    for (const auto& l : m->lists)
      lists.push_back({{"name", l.name},
                       {"default", l.value},
                       {"formulas_in", l.variables.empty() ? json(nullptr) : json(l.variables)},
                       {"doc", l.doc}});
    json texts = json::array();
    for (const auto& t : m->options)
      texts.push_back({{"name", t.name},
                       {"default", t.value},
                       {"choices", t.choices},
                       {"formula_in", t.variable.empty() ? json(nullptr) : json(t.variable)},
                       {"doc", t.doc}});
    all.push_back({{"name", m->name},
                   {"description", m->description},
                   {"source", m->source},
                   {"space", has_space(*m)},
                   {"velocity", m->has_velocity_grid},
                   {"initial", initial_names(*m)},
                   {"parameters", parameters},
                   {"texts", texts},
                   {"lists", lists}});
  }
  return all;
}

json cases() {
  json all = json::array();
  for (const auto& name : case_names()) {
    const case_config c = load_case(name);
    all.push_back(
        {{"name", name}, {"description", c.title}, {"model", c.model.name}, {"method", c.time.method}});
  }
  return all;
}

json schemes() {
  json all = json::array();
  for (const reconstruction_entry* r : reconstruction_entries()) {
    const auto scheme = r->make();
    all.push_back({{"name", r->name},
                   {"description", r->description},
                   {"source", r->source},
                   {"order", scheme->order()},
                   {"ghost_width", scheme->ghost_width()}});
  }
  return all;
}

/// Lists the choices of time.controller.
json controllers() {
  json all = json::array();
  for (const step_law& law : step_laws())
    all.push_back({{"name", law.name},
                   {"description", law.title},
                   {"source", law.citation},
                   {"beta", law.beta},
                   {"alpha", law.alpha},
                   {"default", law.name == usual_step_law}});
  return all;
}

/// Lists the choices of space.formulation.
json formulations() {
  json all = json::array();
  for (const discretization_entry* d : discretization_entries()) {
    const discretization& of = d->instance();
    all.push_back({{"name", d->name},
                   {"description", d->description},
                   {"source", d->source},
                   {"unknown", of.unknown().plural()},
                   {"only_on_a_line", !of.why_on_a_line().empty()},
                   {"collisions", of.collision_places()}});
  }
  return all;
}

json boundaries() {
  json all = json::array();
  for (const boundary_entry* b : boundary_entries()) {
    json one = {{"name", b->name}, {"description", b->description}};
    if (b->variables != nullptr)
      for (const auto& v : b->variables(prototype(find_model("bgk"))))
        one["variables"].push_back(
            fmt::format("{}: {}{}", v.name, v.doc, v.value ? fmt::format(" [{}]", *v.value) : ""));
    all.push_back(one);
  }
  return all;
}

std::string text_of(const shape_key& key) {
  return fmt::format("{}: {}{}", key.name, key.doc, key.value ? "" : " (needed)");
}

json shapes() {
  json all = json::array();
  for (const shape_entry* s : shape_entries()) {
    json one = {{"name", s->name}, {"description", s->description}, {"dimensions", s->dimensions}};
    for (const shape_key& key : s->keys) one["variables"].push_back(text_of(key));
    for (const shape_key& key : common_shape_keys(s->dimensions.back()))
      one["variables"].push_back(text_of(key));
    all.push_back(one);
  }
  return all;
}

json claims() {
  json all = json::array();
  for (const paper::claim_entry* c : paper::find_claims({}))
    all.push_back({{"name", c->id}, {"description", c->statement}, {"section", c->section}, {"how", c->how}});
  return all;
}

json quantities() {
  json all = json::array();
  for (const validation::quantity_entry* q : validation::quantity_entries()) {
    json one = {{"name", q->name}, {"description", q->description}, {"source", q->source}};
    for (const auto& p : q->parameters)
      one["variables"].push_back(fmt::format("{}: {} [{}]", p.name, p.doc, p.value));
    all.push_back(one);
  }
  return all;
}

json keys() {
  json all = json::array();
  for (const case_key& key : case_schema()) {
    const case_value value = key.load(case_config{});
    const bool has_default = !key.required && !std::holds_alternative<std::monostate>(value);
    json models = json::array();
    for (const model_entry* m : model_entries())
      if (applies(key, *m)) models.push_back(m->name);
    all.push_back({{"name", key.path},
                   {"description", key.doc},
                   {"type", type_text(key.type)},
                   {"range", range_text(key)},
                   {"unit", key.unit},
                   {"required", key.required},
                   {"default", has_default ? json(to_toml(value)) : json(nullptr)},
                   {"choices", key.choices ? json(key.choices(case_config{})) : json::array()},
                   {"models", models}});
  }
  return all;
}

/// Lists the table from which time.method = "auto" chooses.
json choices() {
  json all = json::array();
  for (const choice_row& row : choice_table()) {
    const std::string steps = row.longest_steps     ? "longest steps"
                              : !row.tolerance_from ? "equal steps"
                              : *row.tolerance_from > 0.0
                                  ? fmt::format("tolerance >= {:g}", *row.tolerance_from)
                                  : "any tolerance";
    const std::string bounds = !row.signs ? "" : *row.signs ? ", bounds preserved" : ", no bounds";
    const std::string ratio =
        row.explicit_method ? fmt::format(", C dt/epsilon <= {:g}", resolved_ratio) : std::string();
    all.push_back({{"name", row.method},
                   {"description", fmt::format("{} problem, {}{}{}: {} ({})", row.problem, steps, bounds,
                                               ratio, row.why, row.origin)},
                   {"problem", row.problem},
                   {"signs", row.signs ? json(*row.signs) : json(nullptr)},
                   {"explicit", row.explicit_method},
                   {"longest_steps", row.longest_steps},
                   {"tolerance_from", row.tolerance_from ? json(*row.tolerance_from) : json(nullptr)},
                   {"origin", row.origin}});
  }
  return all;
}

json gases() {
  json all = json::array();
  for (const gas_species& g : known_gases())
    all.push_back(
        {{"name", g.name},
         {"description", fmt::format("m = {:g} kg, mu = {:g} Pa s at {:g} K, w = {:g}, D = {}, Pr = {:.4g}",
                                     g.mass, g.viscosity, g.viscosity_temperature, g.viscosity_exponent,
                                     g.degrees_of_freedom, g.prandtl)},
         {"mass", g.mass},
         {"viscosity", g.viscosity},
         {"viscosity_temperature", g.viscosity_temperature},
         {"viscosity_exponent", g.viscosity_exponent},
         {"degrees_of_freedom", g.degrees_of_freedom},
         {"prandtl", g.prandtl}});
  return all;
}

std::string family_lines() {
  text_table table({true, true});
  for (const family_entry* f : family_entries())
    table.add({f->pattern, fmt::format("S = {} ... {}: {}", f->lowest, f->highest, f->description)});
  return "\nfamilies: every S of the range gives a method\n" + table.text();
}

std::string multistep_lines() {
  text_table table({true, true});
  for (const json& m : multistep())
    table.add({m["name"].get<std::string>(),
               fmt::format("k = {}, order {}, r = {:.3g}", m["steps"].get<int>(), m["order"].get<int>(),
                           m["ssp_coefficient"].get<double>())});
  return "\nmultistep: u^(n+1) from k values before it, at equal steps (docs/methods.md)\n" + table.text();
}

std::string as_text(const std::string& what, const json& all) {
  if (what == "methods") return method_table(all) + family_lines() + multistep_lines();
  if (what == "multistep") return multistep_lines().substr(1);
  if (what == "families") return family_lines().substr(1);
  text_table table({true, true});
  for (const auto& item : all) {
    table.add({item["name"].get<std::string>(), item["description"].get<std::string>()});
    if (item.contains("variables"))
      for (const auto& variable : item["variables"]) table.add({"", "  " + variable.get<std::string>()});
  }
  return table.text();
}

const std::map<std::string, json (*)()>& lists() {
  static const std::map<std::string, json (*)()> all = {
      {"methods", methods}, {"families", families},     {"multistep", multistep},       {"models", models},
      {"cases", cases},     {"schemes", schemes},       {"formulations", formulations}, {"claims", claims},
      {"keys", keys},       {"boundaries", boundaries}, {"quantities", quantities},     {"gases", gases},
      {"choices", choices}, {"shapes", shapes},         {"controllers", controllers}};
  return all;
}

std::vector<std::string> list_names() {
  std::vector<std::string> names;
  for (const auto& [name, unused] : lists()) names.push_back(name);
  return names;
}

/// Returns only the names, without certifying methods.
std::string names_text(const std::string& what) {
  if (what == "methods") return fmt::format("{}\n", fmt::join(method_names(), "\n"));
  std::string out;
  for (const auto& item : lists().at(what)()) out += item["name"].get<std::string>() + "\n";
  return out;
}

struct options {
  std::string what;
  bool json = false, names = false;
};

int list(const options& given) {
  const std::string& what = given.what;
  if (lists().count(what) == 0)
    throw input_error(fmt::format("command line: cannot list '{}' (there is no such list); {}", what,
                                  suggest(what, list_names())));
  if (given.names) {
    print(names_text(what));
    return 0;
  }
  const auto all = lists().at(what)();
  print(given.json ? all.dump(2) + "\n" : as_text(what, all));
  return 0;
}

}  // namespace

namespace {

action define(CLI::App& command) {
  auto given = std::make_shared<options>();
  command.add_option("WHAT", given->what, fmt::format("{}", fmt::join(list_names(), ", ")))->required();
  auto* as_json = command.add_flag("--json", given->json, "print a JSON array");
  command.add_flag("--names", given->names, "print only names, one per line")->excludes(as_json);
  return [given] { return list(*given); };
}

}  // namespace
}  // namespace list_command

extern const command_entry command_list;
const command_entry command_list = {
    .name = "list",
    .summary = fmt::format("List {}", fmt::join(list_command::list_names(), ", ")),
    .place = 30,
    .completion = fmt::format("{}", fmt::join(list_command::list_names(), " ")),
    .define = list_command::define};

}  // namespace apsis::app
