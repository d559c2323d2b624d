#include <apsis/study/steady_sweep.hpp>

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/exact_sum.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis {
namespace {

std::optional<double> number_in(const std::string& text) {
  double x = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(x)) return std::nullopt;
  return x;
}

/// Returns the `points` values of "a..b"; nothing if the text is not a range of numbers.
std::optional<std::vector<std::string>> range_in(const std::string& text, int points) {
  const auto dots = text.find("..");
  if (dots == std::string::npos) return std::nullopt;
  const auto first = number_in(text.substr(0, dots)), last = number_in(text.substr(dots + 2));
  if (!first || !last || *first == *last || points < 2) return std::nullopt;
  constexpr double wide = 4.0;
  const double ratio = *last / *first;
  const bool geometric = ratio >= wide || (ratio > 0.0 && ratio <= 1.0 / wide);
  std::vector<std::string> values;
  for (int k = 0; k < points; ++k) {
    const double part = static_cast<double>(k) / (points - 1);
    const double x = geometric ? *first * std::pow(ratio, part) : *first + (*last - *first) * part;
    values.push_back(k == 0            ? text.substr(0, dots)
                     : k == points - 1 ? text.substr(dots + 2)
                                       : fmt::format("{:.6g}", x));
  }
  return values;
}

/// Returns the mass, that is, the sum of the first invariant.
double content(const model& equation, const field& u) {
  std::vector<double> densities(equation.invariants().size());
  exact_sum sum;
  for (int cell = 0; cell < u.cells() && !densities.empty(); ++cell) {
    equation.invariant_densities(u.row(cell), densities.data());
    sum.add(densities.front());
  }
  return sum.value();
}

/// Returns a state as the start of another run, with the mass of its initial data.
state_source start_from(const std::vector<double>& state) {
  return [&state](const run_setup& setup) {
    field u = setup.initial_state();
    const auto components = static_cast<std::size_t>(u.components());
    if (state.size() != static_cast<std::size_t>(u.cells()) * components) return u;
    const double wanted = content(*setup.equation, u);
    for (int cell = 0; cell < u.cells(); ++cell)
      std::copy_n(state.begin() + static_cast<std::ptrdiff_t>(cell) * u.components(), components,
                  u.row(cell));
    const double given = content(*setup.equation, u);
    if (!(wanted > 0.0 && given > 0.0)) return u;
    for (int cell = 0; cell < u.cells(); ++cell)
      for (std::size_t k = 0; k < components; ++k) u.row(cell)[k] *= wanted / given;
    return u;
  };
}

class sweep {
 public:
  sweep(const std::string& case_name, std::vector<std::string> overrides, varied_key varied,
        const study_control& control)
      : case_name_(case_name),
        overrides_(std::move(overrides)),
        varied_(std::move(varied)),
        control_(control) {}

  sweep_table run() {
    std::vector<case_config> cases;
    for (const std::string& value : varied_.values) {
      cases.push_back(case_of(value));
      static_cast<void>(run_setup(cases.back()));  // refuses errors that only the objects of a case reveal
    }
    table_.title = cases.front().title.empty() ? case_name_ : cases.front().title;
    table_.key = varied_.key;
    for (std::size_t k = 0; k < cases.size(); ++k) {
      table_.rows.push_back({.value = varied_.values[k]});
      sweep_row& row = table_.rows.back();
      done_ = static_cast<double>(k) / static_cast<double>(cases.size());
      try {
        find(cases[k], row);
      } catch (const study_interrupted&) {
        table_.rows.pop_back();
        table_.complete = false;
        break;
      }
    }
    return std::move(table_);
  }

 private:
  case_config case_of(const std::string& value) const {
    std::vector<std::string> keys = overrides_;
    keys.push_back(varied_.key + "=" + value);
    case_config found = load_case(case_name_, keys);
    if (found.steady_state.tolerance) return found;
    keys.push_back(fmt::format("steady.tolerance={}", usual_steady_tolerance));
    return load_case(case_name_, keys);
  }

  void find(const case_config& config, sweep_row& row) {
    row.continued = !last_.empty();
    if (row.continued && try_run(config, start_from(last_), row)) return;
    row.continued = false;
    row.problem.clear();
    try_run(config, {}, row);
  }

  bool try_run(const case_config& config, const state_source& start, sweep_row& row) {
    simulation run(config, start);
    name_fluxes(run);
    try {
      while (!run.finished()) {
        control_.check();
        control_.report(done_, fmt::format("{} = {}  iteration {}", varied_.key, row.value, run.step()));
        run.advance();
      }
    } catch (const numerical_error& failure) {
      row.problem = failure.what();
    }
    row.iterations += run.step();
    row.cpu_s += run.summary().cpu_s;
    row.residual = run.last().residual.front();
    row.min_value = run.last().min_value;
    row.found = run.finished() && row.problem.empty();
    if (!row.found) return false;
    row.flux = run.last().flux;
    last_ = run.state();
    return true;
  }

  void name_fluxes(const simulation& run) {
    if (!table_.fluxes.empty()) return;
    table_.invariants = run.setup().equation->invariants();
    for (const std::string& face : run.setup().open_faces())
      for (const std::string& invariant : run.setup().equation->invariants())
        table_.fluxes.push_back(fmt::format("{}_{}", face, invariant));
  }

  std::string case_name_;
  std::vector<std::string> overrides_;
  varied_key varied_;
  const study_control& control_;
  sweep_table table_;
  std::vector<double> last_;
  double done_ = 0.0;
};

}  // namespace

varied_key parse_sweep(const std::string& text, int points) {
  const auto equals = text.find('=');
  std::string whole = text;
  if (equals != std::string::npos && equals > 0) {
    std::string key = text.substr(0, equals);
    if (key.find('.') == std::string::npos) key = "parameters." + key;
    if (auto values = range_in(text.substr(equals + 1), points)) return {key, std::move(*values)};
    whole = key + text.substr(equals);
  }
  return parse_vary(whole);
}

sweep_table run_sweep(const std::string& case_name, const std::vector<std::string>& overrides,
                      const varied_key& varied, const study_control& control) {
  return sweep(case_name, overrides, varied, control).run();
}

std::vector<std::size_t> visible_fluxes(const sweep_table& table) {
  std::vector<double> sizes(table.fluxes.size(), 0.0);
  for (const sweep_row& row : table.rows)
    for (std::size_t k = 0; k < row.flux.size(); ++k) sizes[k] = std::max(sizes[k], std::abs(row.flux[k]));
  const double largest = sizes.empty() ? 0.0 : *std::max_element(sizes.begin(), sizes.end());
  std::vector<std::size_t> visible;
  for (std::size_t k = 0; k < sizes.size(); ++k)
    if (sizes[k] > 1e-8 * largest) visible.push_back(k);
  return visible;
}

numeric_table to_table(const sweep_table& table) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  numeric_table numbers{{table.key, "iterations", "cpu_s", "residual", "min_value"}, {}};
  for (const std::string& flux : table.fluxes) numbers.columns.push_back("flux_" + flux);
  for (const sweep_row& row : table.rows) {
    std::vector<double> of_row = {number_in(row.value).value_or(static_cast<double>(numbers.rows.size())),
                                  static_cast<double>(row.iterations), row.cpu_s, row.residual,
                                  row.found ? row.min_value : none};
    for (std::size_t k = 0; k < table.fluxes.size(); ++k) of_row.push_back(row.found ? row.flux[k] : none);
    numbers.rows.push_back(std::move(of_row));
  }
  return numbers;
}

nlohmann::ordered_json to_json(const sweep_table& table) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const sweep_row& row : table.rows) {
    nlohmann::ordered_json one = {{table.key, row.value},       {"found", row.found},
                                  {"continued", row.continued}, {"iterations", row.iterations},
                                  {"cpu_s", row.cpu_s},         {"residual", row.residual},
                                  {"min_value", row.min_value}};
    for (std::size_t k = 0; k < row.flux.size(); ++k) one["flux_" + table.fluxes[k]] = row.flux[k];
    if (!row.found) one["problem"] = row.problem;
    rows.push_back(std::move(one));
  }
  return rows;
}

namespace {

/// Returns the invariants with a visible flux, in the order of the fluxes.
std::vector<std::string> invariants_in(const sweep_table& table) {
  std::vector<std::string> found;
  for (const std::size_t k : visible_fluxes(table)) {
    const std::string& name = table.fluxes[k];
    const auto of_face = std::find_if(table.invariants.begin(), table.invariants.end(),
                                      [&](const auto& one) { return name.ends_with("_" + one); });
    if (of_face != table.invariants.end() && std::find(found.begin(), found.end(), *of_face) == found.end())
      found.push_back(*of_face);
  }
  return found;
}

}  // namespace

picture to_picture(const sweep_table& table) {
  picture drawn{"sweep", table.title, fmt::format("Steady states for values of {}.", table.key), {}};
  std::vector<double> x;
  for (const sweep_row& row : table.rows) {
    const auto number = number_in(row.value);
    if (!number) return drawn;
    x.push_back(*number);
  }
  const auto [least, most] = std::minmax_element(x.begin(), x.end());
  const bool logarithmic = *least > 0.0 && *most >= 10.0 * *least;
  for (const std::string& invariant : invariants_in(table)) {
    panel fluxes{"",          table.key, fmt::format("{} into the gas (dimensionless)", invariant),
                 logarithmic, false,     {},
                 {},          {}};
    for (const std::size_t k : visible_fluxes(table)) {
      if (!table.fluxes[k].ends_with("_" + invariant)) continue;
      curve of{table.fluxes[k].substr(0, table.fluxes[k].size() - invariant.size() - 1), x, {}};
      for (const sweep_row& row : table.rows)
        of.y.push_back(row.found ? row.flux[k] : std::numeric_limits<double>::quiet_NaN());
      fluxes.curves.push_back(std::move(of));
    }
    drawn.panels.push_back(std::move(fluxes));
  }
  panel iterations{"", table.key, "iterations", logarithmic, false, {{"", x, {}}}, {}, {}};
  for (const sweep_row& row : table.rows)
    iterations.curves.front().y.push_back(static_cast<double>(row.iterations));
  drawn.panels.push_back(std::move(iterations));
  return drawn;
}

}  // namespace apsis
