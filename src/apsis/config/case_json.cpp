#include <apsis/config/case_json.hpp>

#include <apsis/config/case_schema.hpp>

#include <nlohmann/json.hpp>

namespace apsis {
namespace {

struct to_json_visitor {
  nlohmann::ordered_json operator()(std::monostate) const { return nullptr; }
  // A list of one item is written as this item.
  nlohmann::ordered_json operator()(const std::vector<long>& x) const {
    return x.size() == 1 ? nlohmann::ordered_json(x.front()) : nlohmann::ordered_json(x);
  }
  nlohmann::ordered_json operator()(const std::vector<interval>& x) const {
    return x.size() == 1 ? nlohmann::ordered_json(x.front()) : nlohmann::ordered_json(x);
  }
  template <class T>
  nlohmann::ordered_json operator()(const T& x) const {
    return x;
  }
};

nlohmann::ordered_json to_json(const state_formulas& state) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  for (const auto& [name, formulas] : state)
    out[name] =
        formulas.size() == 1 ? nlohmann::ordered_json(formulas.front()) : nlohmann::ordered_json(formulas);
  return out;
}

nlohmann::ordered_json to_json(const shape_table& table) {
  nlohmann::ordered_json out = {{"shape", table.shape}};
  for (const auto& [key, value] : table.values)
    std::visit([&, name = key](const auto& one) { out[name] = one; }, value);
  for (const auto& [key, parts] : table.parts)
    for (const shape_table& part : parts) out[key].push_back(to_json(part));
  return out;
}

void add_parts(nlohmann::ordered_json& out, const std::vector<initial_part>& parts) {
  for (const auto& part : parts) {
    nlohmann::ordered_json one = {{"weight", part.weight}};
    one.update(to_json(part.state));
    out["part"].push_back(one);
  }
}

nlohmann::ordered_json to_json(const initial_table& initial) {
  nlohmann::ordered_json out = to_json(initial.state);
  if (initial.from_python) out["from"] = "python";
  if (!initial.file.empty()) out["file"] = initial.file;
  if (initial.time) out["time"] = *initial.time;
  add_parts(out, initial.parts);
  for (const auto& region : initial.regions) {
    nlohmann::ordered_json one = {{"where", region.where}};
    one.update(to_json(region.state));
    add_parts(one, region.parts);
    out["region"].push_back(one);
  }
  return out;
}

}  // namespace

nlohmann::ordered_json to_json(const case_config& config) {
  const model_entry* model = try_find_model(config.model.name);
  nlohmann::ordered_json out = {{"source", config.source}};
  for (const case_key& key : case_schema()) {
    const case_value value = key.load(config);
    if ((model != nullptr && !applies(key, *model)) || std::holds_alternative<std::monostate>(value) ||
        (key.path == "model.initial" && !config.prescribed.empty()))
      continue;
    nlohmann::ordered_json* place = &out;  // one object for each table of the path
    for (std::size_t from = 0; from != std::string::npos;) {
      const auto dot = key.path.find('.', from);
      place = &(*place)[key.path.substr(from, dot == std::string::npos ? dot : dot - from)];
      from = dot == std::string::npos ? dot : dot + 1;
    }
    *place = std::visit(to_json_visitor{}, value);
  }
  for (const auto& [name, value] : config.model.parameters) out["model"][name] = value;
  for (const auto& [name, value] : config.model.options) out["model"][name] = value;
  for (const auto& [name, value] : config.model.lists) out["model"][name] = value;
  if (!config.constants.empty()) out["parameters"] = config.constants;
  for (std::size_t k = 0; k < config.faces.size(); ++k)
    if (!config.faces[k].values.empty())
      out["boundary"][face_names[k]].update(to_json(config.faces[k].values));
  for (const auto& solid : config.solids) {
    nlohmann::ordered_json one = {
        {"name", solid.name}, {"from", solid.from}, {"to", solid.to}, {"kind", solid.kind}};
    if (!solid.values.empty()) one.update(to_json(solid.values));
    out["space"]["solid"].push_back(std::move(one));
  }
  for (const auto& body : config.bodies) {
    nlohmann::ordered_json one = {{"name", body.name}, {"kind", body.kind}};
    one.update(to_json(body.shape));
    if (!body.values.empty()) one.update(to_json(body.values));
    out["space"]["body"].push_back(std::move(one));
  }
  if (!config.source_term.empty()) out["source_term"] = to_json(config.source_term);
  if (!config.prescribed.empty()) out["initial"] = to_json(config.prescribed);
  for (const auto& probe : config.output.probes)
    out["output"]["probe"].push_back(
        {{"name", probe.name}, {"from", probe.from}, {"to", probe.to}, {"points", probe.points}});
  for (const auto& slice : config.output.slices)
    out["output"]["slice"].push_back(
        {{"name", slice.name}, {"normal", std::string(1, "xyz"[slice.direction])}, {"at", slice.at}});
  if (const auto& reference = config.output.reference)
    for (const reference_key& key : reference_keys()) {
      auto& to = out["output"]["reference"];
      if (key.vector != nullptr && !((*reference).*key.vector).empty())
        to[key.name] = (*reference).*key.vector;
      if (key.number != nullptr && (*reference).*key.number != 0.0) to[key.name] = (*reference).*key.number;
    }
  return out;
}

nlohmann::ordered_json to_json(const gas_scales& scales) {
  nlohmann::ordered_json out;
  if (!scales.gas().name.empty()) out["gas"] = scales.gas().name;
  for (const auto& one : scales.quantities())
    out[one.name] = {{"value", one.value}, {"unit", unit_of(one.dimension)}};
  return out;
}

}  // namespace apsis
