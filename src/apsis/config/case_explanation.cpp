#include <apsis/config/case_explanation.hpp>

#include <apsis/config/case_schema.hpp>

#include <algorithm>
#include <set>
#include <variant>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Longest value that widens the column of values.
constexpr std::size_t widest_value = 40;

class explainer {
 public:
  explicit explainer(const case_config& config) : config_(config) {}

  std::vector<explained_value> explain() {
    const model_entry& model = find_model(config_.model.name);
    for (const case_key& key : case_schema())
      if (applies(key, model)) add_key(key);
    for (const model_parameter& p : model.parameters)
      if (const auto at = config_.model.parameters.find(p.name); at != config_.model.parameters.end())
        add("model." + p.name, to_toml(case_value(at->second)), at->second == p.value);
    for (const model_option& t : model.options)
      if (const auto at = config_.model.options.find(t.name); at != config_.model.options.end())
        add("model." + t.name, to_toml(case_value(at->second)), at->second == t.value);
    for (const model_list& l : model.lists)
      if (const auto at = config_.model.lists.find(l.name); at != config_.model.lists.end())
        add("model." + l.name, to_toml(case_value(at->second)), at->second == l.value);
    for (const std::string& path : config_.given)
      if (!seen_.contains(path)) all_.push_back({path, "", value_origin::given, ""});
    return std::move(all_);
  }

 private:
  void add_key(const case_key& key) {
    const case_value value = key.load(config_);
    if (std::holds_alternative<std::monostate>(value)) return;
    if (key.path == "model.initial" && !config_.prescribed.empty()) return;
    add(key.path, to_toml(value), value == key.load(case_config{}));
    if (key.path != "time.method" || config_.time.method_reason.empty()) return;
    all_.back().origin = value_origin::derived;
    all_.back().reason = fmt::format("\"auto\": {}", config_.time.method_reason);
  }

  void add(const std::string& path, const std::string& value, bool is_default) {
    seen_.insert(path);
    const value_origin origin = config_.given.contains(path) ? value_origin::given
                                : is_default                 ? value_origin::default_value
                                                             : value_origin::derived;
    all_.push_back({path, value, origin, ""});
  }

  const case_config& config_;
  std::vector<explained_value> all_;
  std::set<std::string> seen_;
};

}  // namespace

std::string to_string(value_origin origin) {
  switch (origin) {
    case value_origin::given:
      return "given";
    case value_origin::default_value:
      return "default";
    case value_origin::derived:
      return "derived";
  }
  return "";
}

std::vector<explained_value> explain(const case_config& config) {
  return explainer(config).explain();
}

std::string explanation_text(const case_config& config) {
  const auto all = explain(config);
  std::vector<std::string> left;
  std::size_t width = 0;
  for (const explained_value& one : all) {
    left.push_back(one.value.empty() ? one.key : fmt::format("{} = {}", one.key, one.value));
    width = std::max(width, std::min(left.back().size(), one.key.size() + 3 + widest_value));
  }
  std::string out;
  for (std::size_t k = 0; k < all.size(); ++k)
    out += fmt::format("{:<{}}  {}{}\n", left[k], width, to_string(all[k].origin),
                       all[k].reason.empty() ? "" : fmt::format(" ({})", all[k].reason));
  return out;
}

}  // namespace apsis
