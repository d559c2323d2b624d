#include <apsis/config/case.hpp>

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/config/case_text.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/core/embedded.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/core/text_file.hpp>
#include <apsis/model/expression.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

namespace apsis {
namespace {

/// From flat keys to a case: one pass over the schema, then what one key alone cannot decide.
class resolver {
 public:
  resolver(case_text text, std::string file) : text_(std::move(text)), file_(std::move(file)) {}

  case_config resolve() {
    config_.source = file_;
    for (const auto& [path, raw] : text_.values) config_.places[path] = raw.place;
    check_tables();
    find_the_model();
    check_known();
    for (const case_key& key : case_schema()) take(key);
    if (config_.model.initial.empty()) config_.model.initial = initial_names(*model_).front();
    take_parameters();
    check_together();
    return config_;
  }

 private:
  const raw_value* find(const std::string& path) const {
    const auto found = text_.values.find(path);
    return found == text_.values.end() ? nullptr : &found->second;
  }

  // Where something is missing: the head of the table in which it should stand, or the first line.
  source_place table_place(const std::string& path) const {
    const auto found = text_.tables.find(path.substr(0, path.find('.')));
    return found != text_.tables.end() ? found->second : source_place{file_, 1, 1};
  }

  void check_tables() const {
    std::vector<std::string> names = {"model", "space", "boundary", "velocity", "time", "output"};
    for (const auto& [name, place] : text_.tables)
      if (std::find(names.begin(), names.end(), name) == names.end())
        throw input_error(place, fmt::format("unknown table [{}] (a case has no such table); {}", shown(name),
                                             suggest(name, names)));
    for (const auto& name : names)
      if (const raw_value* raw = find(name))
        refuse(*raw, name, "it is a table", fmt::format("write [{}]", name));
  }

  void find_the_model() {
    for (const case_key& key : case_schema())
      if (key.path == "model.name") take(key);
    model_ = find_model(config_.model.name);
  }

  std::vector<std::string> valid_paths() const {
    std::vector<std::string> paths;
    for (const case_key& key : case_schema())
      if (applies(key, *model_)) paths.push_back(key.path);
    for (const model_parameter& p : model_->parameters) paths.push_back("model." + p.name);
    for (const model_text& t : model_->texts) paths.push_back("model." + t.name);
    return paths;
  }

  void check_known() const {
    const auto valid = valid_paths();
    for (const auto& [path, raw] : text_.values) {
      if (std::find(valid.begin(), valid.end(), path) != valid.end()) continue;
      for (const case_key& key : case_schema())
        if (key.path == path)
          throw input_error(raw.place, fmt::format("key '{}' is not used (model '{}' {}); remove it", path,
                                                   model_->name, unused_because(key.scope)));
      throw input_error(raw.place, fmt::format("unknown key '{}' (no such key for model '{}'); {}",
                                               shown(path), model_->name, suggest_path(path, valid)));
    }
  }

  static std::string unused_because(key_scope scope) {
    return scope == key_scope::space ? "has no space" : "has no velocity grid";
  }

  // The list of valid keys is that of the table: the whole list is what `apsis show case` is for.
  static std::string suggest_path(const std::string& path, const std::vector<std::string>& valid) {
    std::vector<std::string> same_table;
    const std::string table = path.substr(0, path.find('.') + 1);
    for (const auto& candidate : valid)
      if (!table.empty() && candidate.rfind(table, 0) == 0) same_table.push_back(candidate);
    if (!same_table.empty()) return suggest(path, same_table);
    const std::string near = nearest_word(path, valid);
    return near.empty() ? "see: apsis show case"
                        : fmt::format("did you mean '{}'? see: apsis show case", near);
  }

  void take(const case_key& key) {
    if (model_ != nullptr && !applies(key, *model_)) return;
    const raw_value* raw = find(key.path);
    if (raw == nullptr) {
      if (key.required)
        throw input_error(table_place(key.path),
                          fmt::format("key '{}' is missing ({}); add it, for example: {}", key.path,
                                      model_ == nullptr ? "every case needs it"
                                                        : fmt::format("model '{}' needs it", model_->name),
                                      example(key)));
      return;
    }
    key.store(config_, to_value(key, *raw, config_));
  }

  std::string example(const case_key& key) const {
    const std::string name = key.path.substr(key.path.find('.') + 1);
    if (key.choices != nullptr) {
      const auto names = key.choices(config_);
      return fmt::format("{} = \"{}\"", name, names.empty() ? "" : names.front());
    }
    return fmt::format("{} = {}", name, key.type == key_type::integer ? "100" : "1.0");
  }

  void take_parameters() {
    for (const model_parameter& p : model_->parameters) {
      double value = p.value;
      if (const raw_value* raw = find("model." + p.name)) {
        value = finite_number(*raw, "model." + p.name, type_text(key_type::number));
        if (value < p.lowest || value > p.highest)
          refuse(*raw, "model." + p.name,
                 fmt::format("it must be from {} to {}: {}", p.lowest, p.highest, p.doc),
                 "change it to a value in this range");
        if (p.integer && value != std::floor(value))
          refuse(*raw, "model." + p.name, fmt::format("it must be an integer: {}", p.doc),
                 "give a whole number");
      }
      config_.model.parameters[p.name] = value;
    }
    for (const model_text& t : model_->texts) {
      const raw_value* raw = find("model." + t.name);
      config_.model.texts[t.name] = raw == nullptr ? t.value : to_text(t, *raw);
    }
  }

  void check_together() const {
    check_step_rule();
    if (has_space(*model_)) check_mesh();
    check_epsilon();
    check_fields();
    const double snapshots = config_.output.every > 0.0 ? config_.time.end / config_.output.every : 0.0;
    if (snapshots > 1e5)
      refuse(*find("output.every"), "output.every",
             fmt::format("that makes {:.3g} snapshots, at most 100000", snapshots), "give a longer interval");
  }

  void check_step_rule() const {
    std::vector<std::string> given, valid;
    for (const auto& key : step_keys()) {
      if (find(key) != nullptr) given.push_back(key);
      if (has_space(*model_) || key == "time.dt") valid.push_back(key);
    }
    if (given.empty())
      throw input_error(table_place("time.dt"),
                        fmt::format("no step size is given (one of {} is needed); add for example {}",
                                    fmt::format("{}", fmt::join(valid, ", ")),
                                    valid.size() > 1 ? "safety = 0.5" : "dt = 0.01"));
    if (given.size() > 1)
      throw input_error(
          find(given[1])->place,
          fmt::format("'{}' conflicts with '{}' (exactly one of {} sets the step); remove all but one",
                      given[1], given[0], fmt::join(valid, ", ")));
    if (config_.time.dt && config_.time.end > 0.0 && *config_.time.dt > config_.time.end * (1.0 + 1e-12))
      refuse(*find("time.dt"), "time.dt", fmt::format("it is longer than time.end = {}", config_.time.end),
             "give a step of at most the whole time");
  }

  void check_mesh() const {
    const auto [left, right] = config_.space.domain;
    const raw_value* raw = find("space.domain");
    const double width = right - left;
    if (raw != nullptr && !(width > 0.0))
      refuse(*raw, "space.domain", fmt::format("[{}, {}] is not left < right", left, right),
             "give the left end first");
    const double scale = std::max(std::abs(left), std::abs(right));
    if (raw != nullptr && (!std::isfinite(width) || width / config_.space.cells < 1e-12 * scale))
      refuse(*raw, "space.domain",
             fmt::format("cells of [{}, {}] cannot be told apart in double precision", left, right),
             "give a domain nearer to 0 or fewer cells");
    check_faces();
    const double points = static_cast<double>(config_.space.cells) * std::max(1, config_.velocity.points);
    if (points > 2e9)
      refuse(*find("space.cells"), "space.cells",
             fmt::format("with velocity.points = {} that is {:.3g} unknowns, at most 2e9 are possible",
                         config_.velocity.points, points),
             "give fewer cells or velocities");
  }

  void check_faces() const {
    const auto faces = make_boundaries(config_);
    if (faces[0]->periodic() == faces[1]->periodic()) return;
    const char* own = config_.faces.left ? "boundary.left.kind" : "boundary.right.kind";
    refuse(*find(own), own, "only one of the two ends is periodic",
           "write space.boundary = \"periodic\" alone, or give both ends another kind");
  }

  // At cell centres and edges, as far as a thousand points go; the run evaluates it where it needs it.
  void check_epsilon() const {
    const raw_value* raw = find("model.epsilon");
    source_place place = raw != nullptr ? raw->value_place : source_place{file_, 1, 1};
    // A formula begins behind its quotation mark; other text has no columns to point to.
    if (raw != nullptr && place.column > 0) ++place.column;
    const expression formula(config_.model.epsilon, place);
    if (!formula.is_constant() && !has_space(*model_))
      throw input_error(
          place,
          fmt::format("'model.epsilon' depends on x (model '{}' has no space); give a number", model_->name));
    const auto [left, right] = config_.space.domain;
    const int points = has_space(*model_) ? std::min(2 * config_.space.cells, 1000) : 0;
    for (int k = 0; k <= points; ++k)
      formula.evaluate(points == 0 ? 0.0 : left + (right - left) * k / points);
  }

  void check_fields() const {
    if (config_.output.fields.empty()) return;
    std::vector<std::string> names;
    for (const auto& field : make_model(config_)->fields()) names.push_back(field.name);
    for (const auto& name : config_.output.fields)
      if (std::find(names.begin(), names.end(), name) == names.end())
        throw input_error(
            find("output.fields")->place,
            fmt::format("unknown field '{}' in 'output.fields' (model '{}' has no such field); {}",
                        shown(name), model_->name, suggest(name, names)));
  }

  case_text text_;
  std::string file_;
  case_config config_;
  const model_entry* model_ = nullptr;
};

/// How the value of a key may be written on the command line. That of a key that does not exist needs no
/// quotes: it is the key that is wrong.
override_form form_of(const std::string& path) {
  for (const case_key& key : case_schema())
    if (key.path == path)
      return {key.type == key_type::text || key.type == key_type::formula, type_advice(key.type)};
  // No model has a number of the same name as a text of another.
  for (const model_entry* entry : model_entries())
    for (const model_parameter& p : entry->parameters)
      if ("model." + p.name == path)
        return {false, type_advice(p.integer ? key_type::integer : key_type::number)};
  return {true, type_advice(key_type::text)};
}

/// Without spaces around it: "space.cells = 80" is one argument of a shell if it is quoted.
std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

void apply_overrides(case_text& text, const std::vector<std::string>& overrides) {
  struct key_and_value {
    std::string path, value;
    source_place place;
  };
  std::vector<key_and_value> all;
  for (const auto& item : overrides) {
    const source_place place{fmt::format("override '{}'", shown(item)), 0, 0};
    const auto equals = item.find('=');
    const std::string path = trimmed(item.substr(0, equals));
    if (equals == std::string::npos || path.empty())
      throw input_error(
          place, "not of the form key=value (an override sets one key); write for example space.cells=80");
    all.push_back({path, trimmed(item.substr(equals + 1)), place});
  }
  // A step rule on the command line takes the place of the one in the file.
  const auto sets_step = [](const key_and_value& item) { return is_step_key(item.path); };
  if (std::any_of(all.begin(), all.end(), sets_step))
    for (const auto& key : step_keys()) text.values.erase(key);
  for (const auto& [path, value, place] : all) apply_override(text, path, value, form_of(path), place);
}

}  // namespace

case_config parse_case(std::string_view text, const std::string& file,
                       const std::vector<std::string>& overrides) {
  case_text flat = read_case_text(text, file);
  apply_overrides(flat, overrides);
  return resolver(std::move(flat), file).resolve();
}

std::string read_case(const std::string& name_or_path) {
  for (const auto& built_in : embedded::cases())
    if (built_in.name == name_or_path) return std::string(built_in.text);
  std::error_code ignored;
  if (!std::filesystem::exists(name_or_path, ignored))
    throw input_error(fmt::format("no case '{}' (neither a file nor a built-in case); {}",
                                  shown(name_or_path), suggest(name_or_path, case_names())));
  return read_text_file(name_or_path, longest_case_file, "case file");
}

case_config load_case(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  return parse_case(read_case(name_or_path), name_or_path, overrides);
}

std::unique_ptr<model> make_model(const case_config& config) {
  const model_entry* entry = find_model(config.model.name);
  if (entry == nullptr) {
    std::vector<std::string> names;
    for (const model_entry* known : model_entries()) names.push_back(known->name);
    throw input_error(fmt::format("unknown model '{}' (there is no such name); {}", shown(config.model.name),
                                  suggest(config.model.name, names)));
  }
  model_config parts = default_config(*entry);
  for (const auto& [name, value] : config.model.parameters) parts.parameters[name] = value;
  for (const auto& [name, value] : config.model.texts) parts.texts[name] = value;
  parts.velocity = {config.velocity.max, config.velocity.points, config.velocity.equilibrium};
  return entry->make(parts);
}

domain::faces make_boundaries(const case_config& config) {
  return {make_boundary(config.faces.left.value_or(config.space.boundary)),
          make_boundary(config.faces.right.value_or(config.space.boundary))};
}

std::vector<std::string> case_names() {
  std::vector<std::string> names;
  for (const auto& built_in : embedded::cases()) names.emplace_back(built_in.name);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace apsis
