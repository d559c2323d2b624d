#include <apsis/output/case_json.hpp>

#include <apsis/config/case_schema.hpp>

#include <nlohmann/json.hpp>

namespace apsis {
namespace {

struct to_json_visitor {
  nlohmann::ordered_json operator()(std::monostate) const { return nullptr; }
  // A list of one item stands for the item.
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

}  // namespace

nlohmann::ordered_json to_json(const case_config& config) {
  const model_entry* model = find_model(config.model.name);
  nlohmann::ordered_json out = {{"source", config.source}};
  for (const case_key& key : case_schema()) {
    const case_value value = key.load(config);
    if ((model != nullptr && !applies(key, *model)) || std::holds_alternative<std::monostate>(value))
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
  for (const auto& [name, value] : config.model.texts) out["model"][name] = value;
  return out;
}

std::string json_text(const nlohmann::ordered_json& value) {
  return value.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace apsis
