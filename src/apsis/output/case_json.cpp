#include <apsis/output/case_json.hpp>

#include <apsis/config/case_schema.hpp>

#include <nlohmann/json.hpp>

namespace apsis {
namespace {

struct to_json_visitor {
  nlohmann::ordered_json operator()(std::monostate) const { return nullptr; }
  template <class T>
  nlohmann::ordered_json operator()(const T& x) const {
    return x;
  }
};

}  // namespace

nlohmann::ordered_json to_json(const case_config& config) {
  const model_entry* model = find_model(config.model.name);
  nlohmann::ordered_json out = {{"source", config.source}};
  for (const case_key& key : case_schema()) {
    const case_value value = key.load(config);
    if ((model != nullptr && !applies(key, *model)) || std::holds_alternative<std::monostate>(value))
      continue;
    const auto dot = key.path.find('.');
    nlohmann::ordered_json item = std::visit(to_json_visitor{}, value);
    if (dot == std::string::npos)
      out[key.path] = std::move(item);
    else
      out[key.path.substr(0, dot)][key.path.substr(dot + 1)] = std::move(item);
  }
  for (const auto& [name, value] : config.model.parameters) out["model"][name] = value;
  for (const auto& [name, value] : config.model.texts) out["model"][name] = value;
  return out;
}

std::string json_text(const nlohmann::ordered_json& value) {
  return value.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace apsis
