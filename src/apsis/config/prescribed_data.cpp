#include <apsis/config/prescribed_data.hpp>

#include <apsis/core/suggest.hpp>
#include <apsis/exec/interruption.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

/// Numbers of points of a line at which regions are sought: per cell, and at most in total.
constexpr int points_of_a_cell = 64, most_points = 1'000'000;

std::string position_text(const position& x, int dimensions) {
  static const char* const names[] = {"x", "y", "z"};
  std::vector<std::string> parts;
  for (int k = 0; k < dimensions; ++k)
    parts.push_back(fmt::format("{} = {:.10g}", names[k], x[static_cast<std::size_t>(k)]));
  return dimensions == 0 ? "" : fmt::format(" at {}", fmt::join(parts, ", "));
}

}  // namespace

/// The formula of a component of a variable.
struct prescribed_data::formula {
  expression text;
  bool of_velocity = false;  ///< depends also on the velocity
};

/// A state, or the part of one that a region replaces: formulas of the variables of a form. A region need
/// not have all of them.
struct prescribed_data::state {
  struct part {
    expression weight;
    data_form form;
    std::vector<formula> values;
    source_place place;
  };
  data_form form;
  std::vector<std::optional<formula>> values;  ///< in the order of the form, vectors expanded
  std::vector<part> parts;                     ///< replace `values` if there are any
  source_place place;
};

struct prescribed_data::region {
  bool contains(const position& x) const;
  std::vector<double> ends(const grid& mesh) const;

  expression where;
  source_place place;
  state own;
};

class prescribed_data::compiler {
 public:
  compiler(const case_config& config, const model& equation, const places& place_of)
      : table_(config.prescribed),
        forms_(equation.data_forms()),
        place_of_(place_of),
        on_mesh_(equation.space_dimensions() > 0),
        kind_(formula_of_position(equation.space_dimensions(), false, config.constants)),
        kind_of_velocity_(kind_) {
    static const char* const names[] = {"v_x", "v_y", "v_z"};
    for (int k = 0; k < equation.velocities().dimensions(); ++k)
      kind_of_velocity_.variables.emplace_back(names[k]);
  }

  state base() const {
    if (table_.given_elsewhere()) return {};
    const data_form form = layers_form();
    state made = make("initial", table_.state, table_.parts, form);
    if (made.parts.empty()) complete(made, "initial", "no region lies below");
    return made;
  }

  std::vector<region> regions() const {
    std::vector<region> made;
    const data_form form = layers_form();
    bool above_parts = !table_.parts.empty() || table_.given_elsewhere();
    for (std::size_t k = 0; k < table_.regions.size(); ++k) {
      const initial_region& given = table_.regions[k];
      const std::string path = fmt::format("initial.region.{}", k + 1);
      if (given.where.empty())
        throw input_error(place_of_(path),
                          fmt::format("key '{}.where' is missing (a region needs it); add for "
                                      "example where = \"x < 0.5\"",
                                      path));
      if (!on_mesh_)
        throw input_error(place_of_(path), "a region has no meaning (the model has no space); remove it");
      if (given.state.empty() && given.parts.empty())
        throw input_error(
            place_of_(path),
            fmt::format("the region '{}' changes nothing (it has no variables); add one", given.where));
      state own = make(path, given.state, given.parts, form);
      if (above_parts && own.parts.empty())
        complete(own, path,
                 table_.given_elsewhere() ? "the data below the region are those of a file"
                                          : "a sum of parts lies below the region");
      above_parts = above_parts || !own.parts.empty();
      made.push_back({compile(path + ".where", given.where), place_of_(path + ".where"), std::move(own)});
    }
    return made;
  }

 private:
  static std::size_t size(const data_variable& variable) { return static_cast<std::size_t>(variable.size); }

  /// Fills in defaults. Throws input_error if a required variable is missing; `why` is the
  /// reason in the message.
  void complete(state& made, const std::string& path, const std::string& why) const {
    std::size_t at = 0;
    for (const auto& variable : made.form.variables)
      for (std::size_t c = 0; c < size(variable); ++c, ++at) {
        if (made.values[at].has_value()) continue;
        if (!variable.value)
          throw input_error(place_of_(path),
                            fmt::format("key '{}.{}' is missing (it is the {}, and {}); add it", path,
                                        variable.name, variable.doc, why));
        made.values[at].emplace(expression(fmt::format("{}", *variable.value), source_place{}, kind_));
      }
  }

  /// Compiles a formula, which may depend on the position only if there is space.
  expression compile(const std::string& path, const std::string& text) const {
    expression made(text, place_of_(path), kind_);
    if (!on_mesh_ && !made.is_constant())
      throw input_error(place_of_(path),
                        fmt::format("'{}' depends on x (the model has no space); give a number", path));
    return made;
  }

  /// Returns the form of the variables of all layers together, since a region changes some of those below.
  data_form layers_form() const {
    std::set<std::string> names;
    for (const auto& [name, formulas] : table_.state) names.insert(name);
    for (const auto& region : table_.regions)
      for (const auto& [name, formulas] : region.state) names.insert(name);
    return form_with(names, "initial");
  }

  /// Returns the first form with all of these variables, if possible one without other required variables.
  data_form form_with(const std::set<std::string>& names, const std::string& path) const {
    const data_form* fallback = nullptr;
    for (const auto& form : forms_) {
      std::set<std::string> missing = names;
      bool complete = true;
      for (const auto& variable : form.variables) {
        complete = complete && (missing.count(variable.name) > 0 || variable.value.has_value());
        missing.erase(variable.name);
      }
      if (missing.empty() && complete) return form;
      if (missing.empty() && fallback == nullptr) fallback = &form;
    }
    if (fallback != nullptr) return *fallback;
    std::vector<std::string> valid;
    for (const auto& form : forms_) {
      std::vector<std::string> of_form;
      for (const auto& variable : form.variables) of_form.push_back(variable.name);
      valid.push_back(fmt::format("{}", fmt::join(of_form, ", ")));
    }
    throw input_error(
        place_of_(path),
        fmt::format("the variables {} do not belong together (a state is given by {}); leave some "
                    "out",
                    fmt::join(names, ", "), fmt::join(valid, "; or by ")));
  }

  state make(const std::string& path, const state_formulas& formulas, const std::vector<initial_part>& parts,
             const data_form& form) const {
    state made;
    made.place = place_of_(path);
    if (!parts.empty() && !formulas.empty())
      throw input_error(made.place, fmt::format("'{}' has variables and parts (the parts are the whole sum); "
                                                "write a further [[{}.part]]",
                                                path, path));
    for (std::size_t k = 0; k < parts.size(); ++k)
      made.parts.push_back(make_part(fmt::format("{}.part.{}", path, k + 1), parts[k]));
    if (!parts.empty()) return made;
    made.form = form;
    made.values = values_of(path, formulas, form);
    return made;
  }

  state::part make_part(const std::string& path, const initial_part& given) const {
    std::set<std::string> names;
    for (const auto& [name, formulas] : given.state) names.insert(name);
    state whole;
    whole.form = form_with(names, path);
    whole.values = values_of(path, given.state, whole.form);
    complete(whole, path, "a part is a whole state");
    std::vector<formula> values;
    for (auto& value : whole.values) values.push_back(std::move(*value));
    return {compile(path + ".weight", given.weight), whole.form, std::move(values), place_of_(path)};
  }

  std::vector<std::optional<formula>> values_of(const std::string& path, const state_formulas& formulas,
                                                const data_form& form) const {
    std::vector<std::optional<formula>> values;
    for (const auto& variable : form.variables) {
      const std::size_t first = values.size(), count = size(variable);
      values.resize(first + count);
      const auto given = formulas.find(variable.name);
      if (given == formulas.end()) continue;
      const std::string key = path + "." + variable.name;
      if (given->second.size() != count && given->second.size() != 1)
        throw input_error(
            place_of_(key),
            fmt::format("'{}' has {} components (the model has {}); give {}, or one alone along x", key,
                        given->second.size(), count, count));
      for (std::size_t c = 0; c < count; ++c) {
        const std::string text = c < given->second.size() ? given->second[c] : "0";
        if (variable.of_velocity)
          values[first + c].emplace(expression(text, place_of_(key), kind_of_velocity_), true);
        else
          values[first + c].emplace(compile(key, text));
      }
    }
    return values;
  }

  const initial_table& table_;
  std::vector<data_form> forms_;
  const places& place_of_;
  bool on_mesh_;
  formula_kind kind_, kind_of_velocity_;
};

prescribed_data::prescribed_data(const case_config& config, const model& equation, const places& place_of,
                                 row_function below)
    : below_(std::move(below)), dimensions_(equation.space_dimensions()), velocities_(equation.velocities()) {
  const compiler from(config, equation, place_of);
  base_ = std::make_unique<state>(from.base());
  regions_ = from.regions();
}

prescribed_data::~prescribed_data() = default;
prescribed_data::prescribed_data(prescribed_data&&) noexcept = default;

void prescribed_data::operator()(const position& x, std::span<double> u) const {
  const auto covers = [&x](const region& one) { return one.contains(x); };
  if (below_ && std::none_of(regions_.begin(), regions_.end(), covers)) return below_(x, u);
  const state* top = base_.get();  // has parts, or the form of all layers
  std::vector<const formula*> values(base_->values.size());
  source_place place = base_->place;
  const auto lay = [&](const state& layer) {
    place = layer.place;
    top = &layer;
    values.resize(layer.parts.empty() ? std::max(values.size(), layer.values.size()) : 0);
    for (std::size_t k = 0; k < layer.values.size(); ++k)
      if (layer.values[k].has_value()) values[k] = &*layer.values[k];
  };
  lay(*base_);
  for (const region& one : regions_)
    if (one.contains(x)) lay(one.own);
  const auto fill = [&](const data_form& form, std::span<const double> numbers, const source_place& at,
                        std::span<double> row) {
    const std::string problem = form.row(numbers, row);
    if (!problem.empty())
      throw input_error(at,
                        fmt::format("the initial data have no {}{} ({}); change the formulas or the domain",
                                    form.description, position_text(x, dimensions_), problem));
  };
  std::vector<double> numbers;
  if (top->parts.empty()) {
    for (const formula* value : values) append(*value, x, numbers);
    return fill(top->form, numbers, place, u);
  }
  std::vector<double> term(u.size());
  std::fill(u.begin(), u.end(), 0.0);
  for (const auto& part : top->parts) {
    numbers.clear();
    for (const formula& value : part.values) append(value, x, numbers);
    fill(part.form, numbers, part.place, term);
    const double weight = part.weight.evaluate(x);
    for (std::size_t k = 0; k < u.size(); ++k) u[k] += weight * term[k];
  }
}

void prescribed_data::append(const formula& of, const position& x, std::vector<double>& numbers) const {
  if (!of.of_velocity) return numbers.push_back(of.text.evaluate(x));
  const auto space = static_cast<std::size_t>(dimensions_),
             count = static_cast<std::size_t>(velocities_.size()),
             width = space + static_cast<std::size_t>(velocities_.dimensions());
  std::vector<double> arguments(count * width);
  for (std::size_t j = 0; j < count; ++j) {
    std::copy_n(x.begin(), space, arguments.begin() + static_cast<std::ptrdiff_t>(j * width));
    for (std::size_t k = space; k < width; ++k)
      arguments[j * width + k] = velocities_.speeds(static_cast<int>(k - space))[j];
  }
  const std::size_t first = numbers.size();
  numbers.resize(first + count);
  of.text.values(arguments, std::span(numbers).subspan(first));
  for (std::size_t j = 0; j < count; ++j)
    if (!std::isfinite(numbers[first + j])) of.text.evaluate(std::span(arguments).subspan(j * width, width));
}

bool prescribed_data::region::contains(const position& x) const {
  return where.evaluate(x) != 0.0;
}

std::vector<double> prescribed_data::jumps(const grid& mesh) const {
  std::vector<double> found;
  for (const region& one : regions_) {
    const std::vector<double> ends = mesh.dimensions() == 1 ? one.ends(mesh) : std::vector<double>{};
    // An end at the end of the domain encloses nothing.
    bool covers = std::any_of(ends.begin(), ends.end(), [&](double x) {
      return std::min(x - mesh.centre(0, 0), mesh.centre(mesh.size() - 1, 0) - x) >
             (1e-9 - 0.5) * mesh.spacing(0);
    });
    for (int cell = 0; cell < mesh.size() && !covers; ++cell) {
      interruptible::poll();
      covers = one.contains(mesh.centre(cell));
    }
    if (!covers)
      throw input_error(one.place,
                        fmt::format("the region '{}' covers no point of the mesh (its condition is 0 "
                                    "everywhere); change the condition or remove the region",
                                    one.where.text()));
    found.insert(found.end(), ends.begin(), ends.end());
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Returns the points of a line at which the condition changes: the first numbers on the right
/// side, to the last bit.
std::vector<double> prescribed_data::region::ends(const grid& mesh) const {
  const long steps = mesh.size() * std::clamp<long>(most_points / mesh.size(), 2, points_of_a_cell);
  const double lower = mesh.centre(0, 0) - 0.5 * mesh.spacing(0),
               upper = mesh.centre(mesh.size() - 1, 0) + 0.5 * mesh.spacing(0);
  const auto inside = [&](double x) { return contains({x, 0.0, 0.0}); };
  std::vector<double> found;
  double before = lower;
  bool was_inside = inside(before);
  for (long k = 0; k <= steps; ++k) {
    interruptible::poll();
    // Samples midpoints of equal intervals, since regions often end where cells do, and then
    // the end of the domain.
    const double at =
        k == steps ? upper
                   : lower + (upper - lower) * ((static_cast<double>(k) + 0.5) / static_cast<double>(steps));
    if (inside(at) != was_inside) {
      double left = before, right = at;
      for (double x = 0.5 * (left + right); x > left && x < right; x = 0.5 * (left + right))
        (inside(x) == was_inside ? left : right) = x;
      found.push_back(right);
      was_inside = !was_inside;
    }
    before = at;
  }
  return found;
}

}  // namespace apsis
