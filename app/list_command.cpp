#include "commands.hpp"
#include "method_report.hpp"

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/method/family_registry.hpp>
#include <apsis/method/method.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/space/reconstruction_registry.hpp>
#include <apsis/study/claim_registry.hpp>

#include <map>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
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

json models() {
  json all = json::array();
  for (const model_entry* m : model_entries()) {
    json parameters = json::array();
    for (const auto& p : m->parameters)
      parameters.push_back({{"name", p.name},
                            {"default", p.value},
                            {"lowest", p.lowest},
                            {"highest", p.highest},
                            {"doc", p.doc}});
    json texts = json::array();
    for (const auto& t : m->texts)
      texts.push_back({{"name", t.name},
                       {"default", t.value},
                       {"choices", t.choices},
                       {"formula_in", t.variable.empty() ? json(nullptr) : json(t.variable)},
                       {"doc", t.doc}});
    all.push_back({{"name", m->name},
                   {"description", m->description},
                   {"source", m->source},
                   {"space", m->has_space},
                   {"velocity", m->has_velocity},
                   {"epsilon", m->has_epsilon},
                   {"initial", m->initial},
                   {"parameters", parameters},
                   {"texts", texts}});
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

json claims() {
  json all = json::array();
  for (const claim_entry* c : find_claims({}))
    all.push_back({{"name", c->id}, {"description", c->statement}, {"section", c->section}, {"how", c->how}});
  return all;
}

std::string family_lines() {
  std::string out = "\nfamilies: any S of the range gives a method\n";
  for (const family_entry* f : family_entries())
    out += fmt::format("{:<26}S = {} ... {}: {}\n", f->pattern, f->lowest, f->highest, f->description);
  return out;
}

std::string as_text(const std::string& what, const json& all) {
  if (what == "methods") return method_table(all) + family_lines();
  if (what == "families") return family_lines().substr(1);
  std::string out;
  for (const auto& item : all)
    out += fmt::format("{:<34}{}\n", item["name"].get<std::string>(), item["description"].get<std::string>());
  return out;
}

int list(const std::string& what, bool as_json) {
  static const std::map<std::string, json (*)()> lists = {{"methods", methods}, {"families", families},
                                                          {"models", models},   {"cases", cases},
                                                          {"schemes", schemes}, {"claims", claims}};
  const auto found = lists.find(what);
  if (found == lists.end()) {
    std::vector<std::string> names;
    for (const auto& [name, unused] : lists) names.push_back(name);
    throw input_error(
        fmt::format("command line: cannot list '{}' (there is no such list) {}", what, suggest(what, names)));
  }
  const json all = found->second();
  print(as_json ? all.dump(2) + "\n" : as_text(what, all));
  return 0;
}

}  // namespace

void add_list(CLI::App& program, action& chosen) {
  struct options {
    std::string what;
    bool json = false;
  };
  auto given = std::make_shared<options>();
  CLI::App* command =
      program.add_subcommand("list", "List methods, families, models, cases, schemes or claims");
  command->add_option("WHAT", given->what, "methods, families, models, cases, schemes or claims")->required();
  command->add_flag("--json", given->json, "print a JSON array");
  command->callback([given, &chosen] { chosen = [given] { return list(given->what, given->json); }; });
}

}  // namespace apsis::app
