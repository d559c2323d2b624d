#include <apsis/config/case_resolver.hpp>

#include <apsis/config/body_reader.hpp>
#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/case_checks.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/config/checked_model.hpp>
#include <apsis/config/common_boundary.hpp>
#include <apsis/config/data_samples.hpp>
#include <apsis/config/discretization_of_case.hpp>
#include <apsis/config/gas_reader.hpp>
#include <apsis/config/initial_reader.hpp>
#include <apsis/config/limiter_of_case.hpp>
#include <apsis/config/method_of_case.hpp>
#include <apsis/config/output_reader.hpp>
#include <apsis/config/parameter_use.hpp>
#include <apsis/config/prescribed_data.hpp>
#include <apsis/config/reference_reader.hpp>
#include <apsis/config/solid_reader.hpp>
#include <apsis/config/source_reader.hpp>
#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

/// Resolves flat keys: in one pass over the schema, then by rules for several keys.
class resolver {
 public:
  resolver(case_text text, std::string file) : text_(std::move(text)), file_(std::move(file)) {}

  case_config resolve() {
    config_.source = file_;
    for (const auto& item : text_.values) config_.given.insert(item.first);
    note_places();
    check_tables();
    find_the_model();
    check_known();
    expand_common_boundary(text_);
    take_gas();
    take_constants();
    const auto derived = derive_epsilon(text_, *model_, config_);
    note_places();  // of derived keys too
    if (is_given("steady")) config_.steady_state.tolerance = usual_steady_tolerance;
    for (const case_key& key : case_schema()) take(key);
    count_iterations();
    if (derived) config_.model.epsilon = *derived;
    complete_space();
    take_parameters();
    const case_checks checks(text_, file_, *model_, config_);
    if (has_space(*model_)) checks.check_dimensions();
    read_solids(text_, *checked_model(), config_);
    read_bodies(text_, *checked_model(), config_);
    take_initial_data();
    read_boundary_values(text_, *checked_model(), config_);
    read_source_values(text_, *checked_model(), config_);
    checks.check_together();
    read_output_tables(text_, *model_, config_);
    if (has_space(*model_)) read_reference_values(text_, *checked_model(), config_);
    choose_parameters();
    config_ = with_chosen_method(std::move(config_));
    if (find("space.limiter") == nullptr) config_.space.limiter = default_limiter(config_);
    return config_;
  }

 private:
  const raw_value* find(const std::string& path) const { return text_.find(path); }

  /// Returns whether the case has a table, or an override sets one of its keys.
  bool is_given(const std::string& table) const {
    return text_.tables.contains(table) ||
           std::any_of(text_.values.begin(), text_.values.end(),
                       [&](const auto& one) { return is_in(one.first, table); });
  }

  source_place table_place(const std::string& path) const { return text_.place_of_missing(path, file_); }

  void note_places() {
    for (const auto& [name, place] : text_.tables) config_.places[name] = place;
    for (const auto& [path, raw] : text_.values)
      config_.places[path] = is_in(path, "initial") || is_in(path, "boundary") ||
                                     is_in(path, "space.solid") || is_in(path, "space.body") ||
                                     is_in(path, "force") || is_in(path, "source") || path == "model.epsilon"
                                 ? place_of_formula(raw)
                                 : raw.place;
  }

  /// Returns the place of a formula, which begins after its quotation mark; other values have no mark.
  static source_place place_of_formula(const raw_value& raw) {
    source_place place = raw.value_place;
    if (place.column > 0 && std::holds_alternative<std::string>(raw.value)) ++place.column;
    return place;
  }

  std::shared_ptr<const model> checked_model() const { return apsis::checked_model(config_); }

  /// Reads the table [initial], or the name of data of the model, by default its first.
  void take_initial_data() {
    const auto equation = checked_model();
    config_.prescribed = read_initial_table(text_, *equation, model_->name, config_.constants);
    const bool named = !config_.model.initial.empty();
    if (config_.prescribed.empty()) {
      if (!named) config_.model.initial = initial_names(*model_).front();
      if (equation->initial().empty())
        throw input_error(
            named ? find("model.initial")->place : table_place("model.name"),
            fmt::format("the case has no initial data (model '{}' has data of a name only with its default "
                        "options); add a table [initial]",
                        model_->name));
      return;
    }
    if (named)
      throw input_error(find("model.initial")->place,
                        "'model.initial' conflicts with the table [initial] (both give the initial data); "
                        "remove one of them");
    prescribed_data(config_, *equation, [this](const std::string& path) { return place_of(config_, path); });
  }

  void check_tables() const {
    std::vector<std::string> names = {"parameters", "gas",    "model",    "initial", "space", "boundary",
                                      "force",      "source", "velocity", "steady",  "time",  "output"};
    for (const auto& [name, place] : text_.tables)
      if (std::find(names.begin(), names.end(), name.substr(0, name.find('.'))) == names.end())
        throw input_error(place, fmt::format("unknown table [{}] (a case has no such table); {}", shown(name),
                                             suggest_table(name, names)));
    for (const auto& name : names)
      if (const raw_value* raw = find(name))
        refuse(*raw, name, "it is a table", fmt::format("write [{}]", name));
  }

  /// Suggests the whole name of a table within another one, such as [[space.body]] for "body".
  static std::string suggest_table(const std::string& name, const std::vector<std::string>& names) {
    if (const std::string nested = nested_table(name); !nested.empty())
      return fmt::format("did you mean {}?", nested);
    return suggest(name, names);
  }

  static std::string nested_table(const std::string& name) {
    for (const char* list :
         {"space.body", "space.solid", "output.probe", "output.slice", "initial.region", "initial.part"})
      if (std::string(list).ends_with("." + name)) return fmt::format("[[{}]]", list);
    const bool face = std::find(face_names.begin(), face_names.end(), name) != face_names.end();
    return face ? fmt::format("[boundary.{}]", name) : "";
  }

  void find_the_model() {
    for (const case_key& key : case_schema())
      if (key.path == "model.name") take(key);
    model_ = try_find_model(config_.model.name);
  }

  std::vector<std::string> valid_paths() const {
    std::vector<std::string> paths;
    for (const case_key& key : case_schema())
      if (applies(key, *model_)) paths.push_back(key.path);
    for (const model_parameter& p : model_->parameters) paths.push_back("model." + p.name);
    for (const model_option& t : model_->options) paths.push_back("model." + t.name);
    for (const model_list& l : model_->lists) paths.push_back("model." + l.name);
    return paths;
  }

  void check_known() const {
    const auto valid = valid_paths();
    for (const auto& [path, raw] : text_.values) {
      if (std::find(valid.begin(), valid.end(), path) != valid.end() || is_in(path, "parameters") ||
          is_in(path, "initial") || path == "output.probe" || is_in(path, "output.probe") ||
          path == "output.slice" || is_in(path, "output.slice") ||
          ((path == reference_table || is_in(path, reference_table)) && has_space(*model_)) ||
          ((is_in(path, "boundary") || is_in(path, "source") || is_in(path, "space.solid") ||
            is_in(path, "space.body")) &&
           has_space(*model_)))
        continue;
      for (const case_key& key : case_schema())
        if (key.path == path)
          throw input_error(raw.place, fmt::format("key '{}' is not used (model '{}' {}); remove it", path,
                                                   model_->name, unused_because(key.scope)));
      throw input_error(
          raw.place, fmt::format("unknown key '{}' ({}); {}", shown(path),
                                 is_in(path, "gas") ? "the table [gas] has no such key"
                                                    : fmt::format("no such key for model '{}'", model_->name),
                                 suggest_path(path, valid)));
    }
  }

  static bool is_in(const std::string& path, const std::string& table) {
    return path.rfind(table + ".", 0) == 0;
  }

  static std::string unused_because(key_scope scope) {
    return scope == key_scope::space ? "has no space" : "has no velocity grid";
  }

  // Suggests keys of the same table only; `apsis show case` lists all.
  std::string suggest_path(const std::string& path, const std::vector<std::string>& valid) const {
    if (find("parameters." + path) != nullptr) return fmt::format("did you mean 'parameters.{}'?", path);
    if (const std::string nested = nested_table(path); !nested.empty())
      return fmt::format("did you mean {}?", nested);
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
      if (key.required && !(key.optional && key.optional(config_)))
        throw input_error(table_place(key.path),
                          fmt::format("key '{}' is missing ({}); add it, for example: {}{}", key.path,
                                      model_ == nullptr ? "every case needs it"
                                                        : fmt::format("model '{}' needs it", model_->name),
                                      example(key), instead_of(key)));
      return;
    }
    key.store(config_, to_value(key, *raw, config_));
  }

  /// Returns the alternative to a missing key, or "".
  std::string instead_of(const case_key& key) const {
    const bool steady = key.path == "time.end" && prototype(*model_).as_relaxation() != nullptr;
    return steady ? ", or add a table [steady] for a steady state" : "";
  }

  std::string example(const case_key& key) const {
    const std::string name = key.path.substr(key.path.find('.') + 1);
    if (key.choices) {
      const auto names = key.choices(config_);
      return fmt::format("{} = \"{}\"", name, names.empty() ? "" : names.front());
    }
    return fmt::format("{} = {}", name,
                       key.type == key_type::integer || key.type == key_type::integers ? "100" : "1.0");
  }

  /// Reads the table [gas], and converts every value that has a unit.
  void take_gas() {
    for (const case_key& key : case_schema())
      if (is_in(key.path, "gas")) take(key);
    config_.scales = read_gas_scales(text_, *model_, config_);
    config_.unit_warnings = warnings_of_missing_units(text_, *model_, config_);
    remove_units(text_, *model_, config_.scales);
    if (config_.scales) set_gas_of_model(text_, *model_, config_);
  }

  /// Sets keys that the case omits, according to the number of dimensions.
  void complete_space() {
    const std::size_t dimensions = config_.space.cells.size();
    if (find("space.domain") == nullptr)
      config_.space.domain.assign(dimensions, config_.space.domain.front());
    if (find(discretization_key) == nullptr)
      config_.space.discretization = default_discretization(static_cast<int>(dimensions)).name;
    if (config_.is_axisymmetric()) complete_axis();
    // Nonlinear weights may never settle where f jumps along rays.
    if (config_.steady_state.tolerance && find("space.reconstruction") == nullptr)
      config_.space.reconstruction = "upwind5";
  }

  /// Chooses point values of r f, and the boundary "axis" if the domain reaches r = 0.
  void complete_axis() {
    const std::size_t radial = config_.space.cells.size() - 1;
    if (find(discretization_key) == nullptr) config_.space.discretization = "finite-difference";
    if (radial > 1 || config_.space.domain.size() <= radial) return;  // refused later
    std::optional<std::string>& kind = config_.faces[2 * radial].kind;
    if (kind || config_.space.domain[radial][0] != 0.0) return;
    kind = "axis";
    erase_common_boundary(text_, config_, face_names[2 * radial]);
  }

  /// Reads the table [parameters].
  void take_constants() {
    for (const auto& [path, raw] : text_.values) {
      if (!is_in(path, "parameters")) continue;
      const std::string name = path.substr(path.find('.') + 1);
      if (const std::string why = why_not_a_constant(name); !why.empty())
        throw input_error(raw.place, fmt::format("parameter '{}' cannot be used ({}); choose another name",
                                                 shown(name), why));
      config_.constants[name] = finite_number(raw, path, type_text(key_type::number));
    }
    check_overridden_parameters(text_);
  }

  void take_parameters() {
    for (const model_parameter& p : model_->parameters) {
      double value = p.value;
      if (const raw_value* raw = find("model." + p.name); raw != nullptr && !is_automatic(p)) {
        const std::string needed =
            type_text(key_type::number) + (p.automatic ? fmt::format(" or \"{}\"", automatic_word) : "");
        value = finite_number(*raw, "model." + p.name, needed);
        if (value < p.lowest || value > p.highest)
          refuse(*raw, "model." + p.name,
                 fmt::format("it must be from {} to {}: {}", p.lowest, p.highest, p.doc),
                 "change it to a value in this range");
        if (p.integer && value != std::floor(value))
          refuse(*raw, "model." + p.name, fmt::format("it must be an integer: {}", p.doc), "give an integer");
      }
      if (p.of_space && value == 0.0)
        value = config_.is_axisymmetric() ? 3.0 : static_cast<double>(config_.space.cells.size());
      config_.model.parameters[p.name] = value;
    }
    for (const model_option& t : model_->options) {
      const raw_value* raw = find("model." + t.name);
      config_.model.options[t.name] = raw == nullptr ? t.value : to_text(t, *raw, config_.constants);
    }
    for (const model_list& l : model_->lists) {
      const raw_value* raw = find("model." + l.name);
      const auto variables = config_.model.lists.find(l.variables);
      config_.model.lists[l.name] =
          raw == nullptr ? l.value
                         : to_list(l, *raw,
                                   variables == config_.model.lists.end() ? std::vector<std::string>{}
                                                                          : variables->second,
                                   config_.constants);
    }
  }

  /// Returns whether the case leaves the parameter to the model.
  bool is_automatic(const model_parameter& p) const {
    const raw_value* raw = find("model." + p.name);
    const auto* word = raw == nullptr ? nullptr : std::get_if<std::string>(&raw->value);
    return p.automatic && (raw == nullptr || (word != nullptr && *word == automatic_word));
  }

  /// Chooses parameters that the case leaves to the model, from its initial data.
  void choose_parameters() {
    for (const model_parameter& p : model_->parameters) {
      if (!is_automatic(p)) continue;
      if (config_.prescribed.given_elsewhere())
        throw input_error(
            place_of(config_, "initial"),
            fmt::format("'model.{}' cannot be chosen automatically (the initial data are not in "
                        "the case); give a number",
                        p.name));
      const auto equation = checked_model();
      const auto rows = sample_data(config_, *equation);  // the same for every mesh of a study
      config_.model.parameters[p.name] =
          with_place_of_key(config_, [&] { return equation->automatic_value(p.name, rows); });
    }
  }

  /// Makes iterations to a steady state count as time.
  void count_iterations() {
    if (!config_.steady_state.tolerance) return;
    config_.time = {};
    config_.time.end = config_.steady_state.iterations;
    config_.time.dt = 1.0;
    // In a case for a run in time, output.every is a time.
    double& every = config_.output.every;
    config_.steady_state.ignores_every = every != std::floor(every);
    if (config_.steady_state.ignores_every) every = 0.0;
  }

  case_text text_;
  std::string file_;
  case_config config_;
  const model_entry* model_ = nullptr;
};

}  // namespace

case_config resolve_case(case_text text, const std::string& file) {
  return resolver(std::move(text), file).resolve();
}

}  // namespace apsis
