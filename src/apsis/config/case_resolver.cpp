#include <apsis/config/case_resolver.hpp>

#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/config/data_samples.hpp>
#include <apsis/config/discretization_of_case.hpp>
#include <apsis/config/force_reader.hpp>
#include <apsis/config/gas_reader.hpp>
#include <apsis/config/initial_reader.hpp>
#include <apsis/config/limiter_of_case.hpp>
#include <apsis/config/method_of_case.hpp>
#include <apsis/config/output_reader.hpp>
#include <apsis/config/prescribed_data.hpp>
#include <apsis/config/solid_reader.hpp>
#include <apsis/config/source_reader.hpp>
#include <apsis/config/steady_of_case.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/model/expression.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

/// Resolves flat keys: one pass over the schema, then checks that involve several keys.
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
    if (has_space(*model_)) check_dimensions();
    read_solids(text_, *checked_model(), config_);
    take_initial_data();
    read_boundary_values(text_, *checked_model(), config_);
    read_source_values(text_, *checked_model(), config_);
    check_together();
    read_output_tables(text_, *model_, config_);
    choose_parameters();
    config_ = with_chosen_method(std::move(config_));
    if (find("space.limiter") == nullptr) config_.space.limiter = default_limiter(config_);
    return config_;
  }

 private:
  const raw_value* find(const std::string& path) const {
    const auto found = text_.values.find(path);
    return found == text_.values.end() ? nullptr : &found->second;
  }

  /// Whether the case has a table, or an override a key of it.
  bool is_given(const std::string& table) const {
    return text_.tables.contains(table) ||
           std::any_of(text_.values.begin(), text_.values.end(),
                       [&](const auto& one) { return is_in(one.first, table); });
  }

  // Returns the place for a missing key: the head of its table, or the first line.
  source_place table_place(const std::string& path) const {
    const auto found = text_.tables.find(path.substr(0, path.find('.')));
    return found != text_.tables.end() ? found->second : source_place{file_, 1, 1};
  }

  void note_places() {
    for (const auto& [name, place] : text_.tables) config_.places[name] = place;
    for (const auto& [path, raw] : text_.values)
      config_.places[path] = is_in(path, "initial") || is_in(path, "boundary") ||
                                     is_in(path, "space.solid") || is_in(path, "force") ||
                                     is_in(path, "source") || path == "model.epsilon"
                                 ? place_of_formula(raw)
                                 : raw.place;
  }

  /// A formula begins after its quotation mark; other text has no columns.
  static source_place place_of_formula(const raw_value& raw) {
    source_place place = raw.value_place;
    if (place.column > 0 && std::holds_alternative<std::string>(raw.value)) ++place.column;
    return place;
  }

  /// Returns body(), and adds the place of the key with which a message of the model begins.
  template <class Body>
  auto with_place_of_key(const Body& body) const {
    try {
      return body();
    } catch (const input_error& failure) {
      const std::string message = failure.what();
      std::string key = message.substr(0, message.find(' '));
      if (key == "model") key = "model.name";  // "model 'NAME' cannot …"
      const source_place place = key.find('.') == std::string::npos ? source_place{} : place_of(config_, key);
      if (place.file.empty()) throw;
      throw input_error(place, message);
    }
  }

  std::shared_ptr<const model> checked_model() const {
    return with_place_of_key([this] { return make_model(config_); });
  }

  /// The table [initial], or a name of data of the model, by default its first.
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
                                             suggest(name, names)));
    for (const auto& name : names)
      if (const raw_value* raw = find(name))
        refuse(*raw, name, "it is a table", fmt::format("write [{}]", name));
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
          ((is_in(path, "boundary") || is_in(path, "source") || is_in(path, "space.solid")) &&
           has_space(*model_)))
        continue;
      for (const case_key& key : case_schema())
        if (key.path == path)
          throw input_error(raw.place, fmt::format("key '{}' is not used (model '{}' {}); remove it", path,
                                                   model_->name, unused_because(key.scope)));
      throw input_error(raw.place, fmt::format("unknown key '{}' (no such key for model '{}'); {}",
                                               shown(path), model_->name, suggest_path(path, valid)));
    }
  }

  static bool is_in(const std::string& path, const std::string& table) {
    return path.rfind(table + ".", 0) == 0;
  }

  static std::string unused_because(key_scope scope) {
    return scope == key_scope::space ? "has no space" : "has no velocity grid";
  }

  // Suggests keys of the same table only; `apsis show case` lists all.
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
      if (key.required && !(key.optional && key.optional(config_)))
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
    if (key.choices) {
      const auto names = key.choices(config_);
      return fmt::format("{} = \"{}\"", name, names.empty() ? "" : names.front());
    }
    return fmt::format("{} = {}", name,
                       key.type == key_type::integer || key.type == key_type::integers ? "100" : "1.0");
  }

  /// The table [gas], and with it everything that has a unit.
  void take_gas() {
    for (const case_key& key : case_schema())
      if (is_in(key.path, "gas")) take(key);
    config_.scales = read_gas_scales(text_, *model_, config_);
    remove_units(text_, *model_, config_.scales);
    if (config_.scales) set_gas_of_model(text_, *model_, config_);
  }

  /// Chooses keys that the case leaves out by the number of dimensions.
  void complete_space() {
    const std::size_t dimensions = config_.space.cells.size();
    if (find("space.domain") == nullptr)
      config_.space.domain.assign(dimensions, config_.space.domain.front());
    if (find(discretization_key) == nullptr)
      config_.space.discretization = default_discretization(static_cast<int>(dimensions)).name;
    // Where f jumps along rays, nonlinear weights may never settle.
    if (config_.steady_state.tolerance && find("space.reconstruction") == nullptr)
      config_.space.reconstruction = "upwind5";
  }

  /// The table [parameters].
  void take_constants() {
    for (const auto& [path, raw] : text_.values) {
      if (!is_in(path, "parameters")) continue;
      const std::string name = path.substr(path.find('.') + 1);
      if (const std::string why = why_not_a_constant(name); !why.empty())
        throw input_error(raw.place, fmt::format("parameter '{}' cannot be used ({}); choose another name",
                                                 shown(name), why));
      config_.constants[name] = finite_number(raw, path, type_text(key_type::number));
    }
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
      if (p.of_space && value == 0.0) value = static_cast<double>(config_.space.cells.size());
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

  /// Whether the case leaves the parameter to the model.
  bool is_automatic(const model_parameter& p) const {
    const raw_value* raw = find("model." + p.name);
    const auto* word = raw == nullptr ? nullptr : std::get_if<std::string>(&raw->value);
    return p.automatic && (raw == nullptr || (word != nullptr && *word == automatic_word));
  }

  /// Parameters that the case leaves to the model, from its initial data.
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
          with_place_of_key([&] { return equation->automatic_value(p.name, rows); });
    }
  }

  void check_together() const {
    check_step_rule();
    if (config_.steady_state.tolerance) check_steady(config_, *checked_model());
    if (has_space(*model_)) check_mesh();
    check_epsilon();
    check_fields();
    if (config_.output.units == units_choice::si && !config_.scales)
      refuse(*find("output.units"), "output.units",
             "the scales are those of a gas, and there is no table [gas]",
             "add the table, or write units = \"dimensionless\"");
    const double snapshots = config_.output.every > 0.0 ? config_.time.end / config_.output.every : 0.0;
    if (snapshots > 1e5)
      refuse(*find("output.every"), "output.every",
             fmt::format("that makes {:.3g} snapshots, at most 100000", snapshots), "give a longer interval");
  }

  /// Iterations to a steady state count as time.
  void count_iterations() {
    if (!config_.steady_state.tolerance) return;
    config_.time = {};
    config_.time.end = config_.steady_state.iterations;
    config_.time.dt = 1.0;
  }

  void check_step_rule() const {
    if (config_.steady_state.tolerance) return;
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
    check_dimensions();
    for (std::size_t k = 0; k < config_.space.domain.size(); ++k)
      check_interval(config_.space.domain[k], config_.space.cells[k]);
    check_discretization();
    check_faces();
    if (!config_.solids.empty()) check_solids();
    make_acceleration(config_, *checked_model());
    const int of_line = config_.velocity.points;
    double points = std::max(1, of_line);
    for (const int cells : config_.space.cells) points *= cells;
    if (points > 2e9)
      refuse(*find("space.cells"), "space.cells",
             fmt::format("with velocity.points = {} that is {:.3g} unknowns, at most 2e9 are possible",
                         of_line, points),
             "give fewer cells or velocities");
  }

  /// One number of cells and one interval for each dimension of the model.
  void check_dimensions() const {
    const auto wanted = static_cast<std::size_t>(checked_model()->space_dimensions());
    const auto check = [&](const std::string& path, std::size_t given, const char* what) {
      if (given == wanted) return;
      const raw_value* raw = find(path);
      throw input_error(raw != nullptr ? raw->place : table_place(path),
                        fmt::format("'{}' has {} {} (model '{}' has {} space dimension{}); give {}", path,
                                    given, what, model_->name, wanted, wanted == 1 ? "" : "s", wanted));
    };
    check("space.cells", config_.space.cells.size(), "numbers");
    check("space.domain", config_.space.domain.size(), "intervals");
    if (config_.space.blocks) check("space.blocks", config_.space.blocks->size(), "numbers");
    for (std::size_t k = 0; config_.space.blocks && k < wanted; ++k)
      if ((*config_.space.blocks)[k] > config_.space.cells[k])
        refuse(*find("space.blocks"), "space.blocks",
               fmt::format("{} blocks share {} cells", (*config_.space.blocks)[k], config_.space.cells[k]),
               "give at most one block for each cell");
  }

  void check_interval(const interval& ends, int cells) const {
    const auto [lower, upper] = ends;
    const raw_value* raw = find("space.domain");
    const double width = upper - lower;
    if (raw != nullptr && !(width > 0.0))
      refuse(*raw, "space.domain", fmt::format("[{}, {}] is not lower < upper", lower, upper),
             "give the lower end first");
    const double scale = std::max(std::abs(lower), std::abs(upper));
    if (raw != nullptr && (!std::isfinite(width) || width / cells < 1e-12 * scale))
      refuse(*raw, "space.domain",
             fmt::format("cells of [{}, {}] cannot be told apart in double precision", lower, upper),
             "give a domain nearer to 0 or fewer cells");
  }

  void check_discretization() const {
    const discretization& chosen = discretization_of(config_);
    const auto dimensions = static_cast<int>(config_.space.cells.size());
    if (const std::string why = chosen.why_on_a_line(); dimensions > 1 && !why.empty())
      refuse(*find(discretization_key), discretization_key, why + ": one space dimension only",
             fmt::format("write \"{}\", or leave it out", default_discretization(dimensions).name));
    const auto places = chosen.collision_places();
    if (!config_.space.collisions ||
        std::find(places.begin(), places.end(), *config_.space.collisions) != places.end())
      return;
    const std::string chosen_by =
        fmt::format("{} = \"{}\"", discretization_key, config_.space.discretization);
    if (places.empty())
      refuse(*find("space.collisions"), "space.collisions",
             fmt::format("{} collide where they are ({})", chosen.unknown().plural(), chosen_by),
             "leave it out");
    refuse(*find("space.collisions"), "space.collisions",
           fmt::format("cells do not collide there ({})", chosen_by),
           suggest(*config_.space.collisions, places));
  }

  void check_solids() const {
    make_mesh(config_);
    const auto walls = make_solid_walls(config_, checked_model());
    for (std::size_t k = 0; k < walls.size(); ++k)
      if (walls[k]->periodic())
        throw input_error(place_of(config_, fmt::format("space.solid.{}.kind", k + 1)),
                          "a solid box cannot be periodic (nothing lies behind its faces); give it a wall, "
                          "for example kind = \"diffuse\"");
    if (const std::string why = discretization_of(config_).why_without_solids(); !why.empty())
      throw input_error(place_of(config_, "space.solid.1"),
                        fmt::format("solid boxes need point values ({}); write {} = \"finite-difference\"",
                                    why, discretization_key));
  }

  void check_faces() const {
    const auto sides = make_boundaries(config_, make_model(config_));
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const auto& [lower, upper] = sides[k];
      if (lower->periodic() == upper->periodic()) continue;
      const std::string own =
          "boundary." + face_names[config_.faces[2 * k].kind ? 2 * k : 2 * k + 1] + ".kind";
      refuse(*find(own), own, "only one of the two ends is periodic",
             "write space.boundary = \"periodic\" alone, or give both ends another kind");
    }
  }

  // At centres and edges of cells along the diagonal, up to a thousand points; the run checks every cell.
  void check_epsilon() const {
    const bool on_mesh = has_space(*model_);
    const auto dimensions = on_mesh ? config_.space.domain.size() : 0;
    const expression formula = make_epsilon(config_, static_cast<int>(dimensions));
    if (!formula.is_constant() && !on_mesh)
      throw input_error(
          place_of(config_, "model.epsilon"),
          fmt::format("'model.epsilon' depends on x (model '{}' has no space); give a number", model_->name));
    const int points = on_mesh ? std::min(2 * config_.space.cells.front(), 1000) : 0;
    for (int k = 0; k <= points; ++k) {
      position x{};
      for (std::size_t d = 0; d < dimensions; ++d) {
        const auto [lower, upper] = config_.space.domain[d];
        x[d] = points == 0 ? 0.0 : lower + (upper - lower) * k / points;
      }
      formula.evaluate(x);
    }
  }

  void check_fields() const {
    if (config_.output.fields.empty()) return;
    std::vector<std::string> names;
    const auto equation = make_model(config_);
    for (const auto& group : equation->fields())
      for (const auto& field : group.names) names.push_back(field.name);
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

}  // namespace

case_config resolve_case(case_text text, const std::string& file) {
  return resolver(std::move(text), file).resolve();
}

}  // namespace apsis
