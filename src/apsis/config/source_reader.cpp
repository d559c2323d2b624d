#include <apsis/config/source_reader.hpp>

#include <apsis/config/case_value.hpp>
#include <apsis/config/space_time_formula.hpp>
#include <apsis/config/suggest_variable.hpp>
#include <apsis/model/gas_model.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

data_form form_of(const model& equation, const source_place& place) {
  auto forms = equation.data_forms();
  if (forms.empty())
    throw input_error(place,
                      "a source cannot be used (the model has no variables that prescribe a state); "
                      "remove the table [source]");
  return std::move(forms.front());
}

/// Returns the names of the functions of the velocity that a gas takes in place of the
/// variables: f, or g and h.
std::vector<std::string> functions_of(const model& equation) {
  const auto* gas = equation.as_gas();
  if (gas == nullptr) return {};
  std::vector<std::string> names;
  for (const auto& variable : gas->molecules().distribution_form().variables) names.push_back(variable.name);
  return names;
}

bool by_functions(const case_config& config, const model& equation) {
  const auto names = functions_of(equation);
  return std::any_of(names.begin(), names.end(),
                     [&](const auto& name) { return config.source_term.contains(name); });
}

[[noreturn]] void fail(double t, const position& x, const std::string& why) {
  throw numerical_error(fmt::format("there is no source at x = {:.6g} ({}); change its formulas", x[0], why),
                        {-1, t, -1, std::numeric_limits<double>::quiet_NaN()});
}

space_time_formula compile(const case_config& config, const model& equation, const std::string& name,
                           std::size_t k, int velocity = 0, const std::vector<std::string>& state = {}) {
  return {config.source_term.at(name)[k],
          place_of(config, "source." + name),
          config.constants,
          equation.space_dimensions(),
          velocity,
          state};
}

/// Returns a source by functions of the velocity, one for each set of components.
source_rate rate_by_functions(const case_config& config, const model& equation) {
  const velocity_set& velocities = equation.velocities();
  std::vector<space_time_formula> formulas;
  const auto names = functions_of(equation);
  for (const auto& [name, texts] : config.source_term)
    if (std::find(names.begin(), names.end(), name) == names.end() || texts.size() != 1)
      throw input_error(
          place_of(config, "source." + name),
          fmt::format("'source.{}' does not go with a function of the velocity (which is one formula "
                      "for each of: {}); remove one of them",
                      name, fmt::join(names, ", ")));
  for (const auto& name : names) {
    if (!config.source_term.contains(name))
      throw input_error(place_of(config, "source"),
                        fmt::format("the table [source] has no '{}' (rows of this gas are {}); add it", name,
                                    fmt::join(names, ", ")));
    formulas.push_back(compile(config, equation, name, 0, velocities.dimensions()));
  }
  const bool steady =
      std::all_of(formulas.begin(), formulas.end(), [](const auto& one) { return one.is_steady(); });
  const auto value = [formulas, velocities, names](double t, const position& x, std::span<const double>,
                                                   std::span<double> row) {
    const auto n = static_cast<std::size_t>(velocities.size());
    for (std::size_t set = 0; set < formulas.size(); ++set)
      for (std::size_t j = 0; j < n; ++j) {
        position v{};
        for (int k = 0; k < velocities.dimensions(); ++k)
          v[static_cast<std::size_t>(k)] = velocities.speeds(k)[j];
        double& one = row[set * n + j];
        one = formulas[set].at(t, x, v);
        if (one < 0.0) fail(t, x, fmt::format("{} is {:.6g} at v_x = {:.6g}", names[set], one, v[0]));
      }
  };
  return {value, steady};
}

/// The source of a law: formulas for its variables, which may depend on these variables.
class rate_by_state {
 public:
  rate_by_state(const case_config& config, const model& equation)
      : form_(form_of(equation, place_of(config, "source"))), equation_(equation) {
    std::vector<std::string> names;
    for (const auto& variable : form_.variables) names.push_back(variable.name);
    for (const auto& name : names) {
      const auto given = config.source_term.find(name);
      if (given == config.source_term.end()) {
        formulas_.emplace_back();
        continue;
      }
      if (given->second.size() > 1)
        throw input_error(place_of(config, "source." + name),
                          fmt::format("'source.{}' has {} components (the variable has 1); give 1", name,
                                      given->second.size()));
      formulas_.emplace_back(compile(config, equation, name, 0, 0, names));
    }
  }

  void operator()(double t, const position& x, std::span<const double> u, std::span<double> row) const {
    values state{}, rates{};
    form_.source->variables(u, state);
    evaluate(t, x, state, rates);
    form_.source->row(state, rates, row);
  }

  /// Returns the Frobenius norm of D⁻¹ ∂S/∂u D with the sizes D of the variables. It bounds the
  /// eigenvalues of ∂S/∂u.
  double growth(double t, const position& x, std::span<const double> u) const {
    constexpr double part = 1e-6;
    const std::size_t n = formulas_.size();
    values state{}, rates{}, beside{}, sizes{};
    form_.source->variables(u, state);
    evaluate(t, x, state, rates);
    equation_.invariant_scales({state.data(), n}, sizes.data());
    const double largest = *std::max_element(sizes.begin(), sizes.end());
    for (double& size : sizes) size = std::max(size, largest > 0.0 ? 0.1 * largest : 1.0);
    double sum = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      values moved = state;
      moved[k] += part * sizes[k];
      evaluate(t, x, moved, beside);
      for (std::size_t j = 0; j < n; ++j) {
        const double slope = (beside[j] - rates[j]) / (part * sizes[j]);
        sum += slope * slope;
      }
    }
    return std::sqrt(sum);
  }

 private:
  using values = std::array<double, 16>;

  void evaluate(double t, const position& x, const values& state, values& rates) const {
    for (std::size_t k = 0; k < formulas_.size(); ++k) {
      if (!formulas_[k]) continue;
      rates[k] = formulas_[k]->at_state(t, x, state);
      if (!std::isfinite(rates[k]))
        fail(t, x, fmt::format("'source.{}' is {} at {}", form_.variables[k].name, rates[k], text_of(state)));
    }
  }
  std::string text_of(const values& state) const {
    std::vector<std::string> parts;
    for (std::size_t k = 0; k < formulas_.size(); ++k)
      parts.push_back(fmt::format("{} = {:.6g}", form_.variables[k].name, state[k]));
    return fmt::format("{}", fmt::join(parts, ", "));
  }

  data_form form_;
  const model& equation_;
  std::vector<std::optional<space_time_formula>> formulas_;  ///< empty where the rate is 0
};

/// Formulas of all components of the variables, and defaults for components without a formula.
struct compiled {
  data_form form;
  std::vector<std::optional<space_time_formula>> formulas;
  std::vector<double> defaults;
};

compiled compile_variables(const case_config& config, const model& equation) {
  const source_place table = place_of(config, "source");
  compiled all{form_of(equation, table), {}, {}};
  for (const auto& variable : all.form.variables) {
    const auto given = config.source_term.find(variable.name);
    if (given == config.source_term.end() && !variable.value)
      throw input_error(table, fmt::format("the table [source] has no '{}' (it is the {}); add it",
                                           variable.name, variable.doc));
    const std::size_t size = static_cast<std::size_t>(variable.size),
                      known = given == config.source_term.end() ? 0 : given->second.size();
    if (known > size)
      throw input_error(place_of(config, "source." + variable.name),
                        fmt::format("'source.{}' has {} components (the model has {}); give {}",
                                    variable.name, known, size, size));
    for (std::size_t k = 0; k < size; ++k) {
      all.defaults.push_back(variable.value.value_or(0.0));
      all.formulas.emplace_back(k < known ? std::optional(compile(config, equation, variable.name, k))
                                          : std::nullopt);
    }
  }
  return all;
}

/// Returns a source by the variables of the model. A Maxwellian is `rho` times that of density 1.
source_rate rate_by_variables(const case_config& config, const model& equation) {
  const compiled all = compile_variables(config, equation);
  const auto& names = all.form.variables;
  const bool scales = names.size() == 3 && names.front().name == "rho" && names.back().name == "T";
  const bool steady = std::all_of(all.formulas.begin(), all.formulas.end(),
                                  [](const auto& one) { return !one || one->is_steady(); });
  const auto value = [all, scales](double t, const position& x, std::span<const double>,
                                   std::span<double> row) {
    std::vector<double> values = all.defaults;
    for (std::size_t k = 0; k < values.size(); ++k)
      if (all.formulas[k]) values[k] = all.formulas[k]->at(t, x);
    const double rate = scales ? std::exchange(values.front(), 1.0) : 1.0;
    if (rate < 0.0) fail(t, x, fmt::format("the rate of density {:.6g} is negative", rate));
    if (rate == 0.0) return std::fill(row.begin(), row.end(), 0.0);
    if (const std::string problem = all.form.row(values, row); !problem.empty()) fail(t, x, problem);
    for (double& one : row) one *= rate;
  };
  return {value, steady};
}

}  // namespace

void read_source_values(const case_text& text, const model& equation, case_config& config) {
  const std::string head = "source.";
  for (const auto& [path, raw] : text.values) {
    if (path.rfind(head, 0) != 0) continue;
    const std::string name = path.substr(head.size());
    std::vector<std::string> names;
    for (const auto& variable : form_of(equation, raw.place).variables) names.push_back(variable.name);
    for (const auto& function : functions_of(equation)) names.push_back(function);
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw input_error(raw.place, fmt::format("unknown key '{}' (a source has no such variable); {}",
                                               shown(path), suggest_variable(name, names)));
    config.source_term[name] = formula_texts(raw, path);
  }
}

std::optional<source_rate> make_source(const case_config& config, const model& equation) {
  if (config.source_term.empty()) return std::nullopt;
  if (form_of(equation, place_of(config, "source")).source) {
    const auto rate = std::make_shared<const rate_by_state>(config, equation);
    return source_rate{
        [rate](double t, const position& x, std::span<const double> u, std::span<double> row) {
          (*rate)(t, x, u, row);
        },
        false,
        [rate](double t, const position& x, std::span<const double> u) { return rate->growth(t, x, u); }};
  }
  source_rate rate = by_functions(config, equation) ? rate_by_functions(config, equation)
                                                    : rate_by_variables(config, equation);
  std::vector<double> row(static_cast<std::size_t>(equation.components()));
  const grid mesh = make_mesh(config);
  for (int cell = 0; cell < mesh.size(); ++cell) try {
      rate.value(0.0, mesh.centre(cell), {}, row);
    } catch (const numerical_error& failure) {
      throw input_error(place_of(config, "source"), failure.problem());
    }
  return rate;
}

}  // namespace apsis
