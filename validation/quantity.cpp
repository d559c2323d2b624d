#include <validation/quantity.hpp>

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

namespace apsis::validation {
namespace {

std::vector<std::string> names_of(const quantity_entry& quantity) {
  std::vector<std::string> names;
  for (const auto& parameter : quantity.parameters) names.push_back(parameter.name);
  return names;
}

std::size_t place_in(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::out_of_range("no '" + name + "' in the run");
  return static_cast<std::size_t>(found - names.begin());
}

/// Returns the number that a whole text represents; NaN for other texts.
double number_of(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value
                                                                  : std::numeric_limits<double>::quiet_NaN();
}

/// Returns the means over lines of n cells, from consecutive values at their centres.
std::vector<double> means_of_lines(const std::vector<double>& values, std::size_t n) {
  std::vector<double> means;
  for (std::size_t first = 0; first < values.size(); first += n) {
    const double* line = values.data() + first;
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      // The average over a cell is the value at its centre + second difference/24. End cells take the second
      // difference of their neighbours.
      const std::size_t at = std::clamp<std::size_t>(i, 1, n - 2);
      sum += line[i] + (line[at - 1] - 2.0 * line[at] + line[at + 1]) / 24.0;
    }
    means.push_back(sum / static_cast<double>(n));
  }
  return means;
}

}  // namespace

const quantity_entry& find_quantity(const std::string& name) {
  std::vector<std::string> names;
  for (const quantity_entry* entry : quantity_entries()) {
    if (entry->name == name) return *entry;
    names.push_back(entry->name);
  }
  throw input_error(fmt::format("unknown quantity '{}' (there is no such name); {}", name.substr(0, 60),
                                suggest(name, names)));
}

double compute_quantity(const quantity_entry& quantity, const std::vector<std::string>& settings,
                        const std::function<bool(double)>& progress) {
  quantity_values values;
  for (const auto& parameter : quantity.parameters) values[parameter.name] = parameter.value;
  std::vector<std::string> overrides;
  for (const auto& setting : settings) {
    const auto equals = setting.find('=');
    const std::string name = setting.substr(0, equals);
    if (equals == std::string::npos)
      throw input_error(fmt::format(
          "'{}' is not of the form name=value (it sets a parameter); write for example "
          "{}={}",
          setting.substr(0, 60), quantity.parameters.front().name, quantity.parameters.front().value));
    if (name.find('.') != std::string::npos) {
      overrides.push_back(setting);
    } else if (values.contains(name)) {
      values[name] = setting.substr(equals + 1);
    } else {
      throw input_error(fmt::format("unknown parameter '{}' of '{}' (keys of its case have a dot); {}",
                                    name.substr(0, 60), quantity.name, suggest(name, names_of(quantity))));
    }
  }
  return quantity.compute(values, [&](const std::string& name, std::vector<std::string> own) {
    own.insert(own.end(), overrides.begin(), overrides.end());
    simulation run(load_case(name, own));
    while (!run.finished()) {
      run.advance();
      const long total = std::max(run.steps_total(), 1L);
      if (progress && progress(static_cast<double>(run.step()) / static_cast<double>(total)))
        throw quantity_interrupted();
    }
    return run;
  });
}

reference_value printed(origin from, quantity_values at, const std::string& digits, double accuracy) {
  const std::size_t point = digits.find('.');
  const auto decimals = point == std::string::npos ? 0 : digits.size() - point - 1;
  const double value = std::stod(digits), half_unit = 0.5 * std::pow(10.0, -static_cast<double>(decimals));
  return {std::move(at), value, half_unit / std::abs(value) + accuracy, from};
}

double positive_number(const quantity_values& parameters, const std::string& name) {
  const double value = number_of(parameters.at(name));
  if (!(value > 0.0) || std::isinf(value))
    throw input_error(fmt::format(
        "{} = '{}' is not a number > 0 (the parameter has no other values); write for example {}=1", name,
        parameters.at(name).substr(0, 60), name));
  return value;
}

double number_between(const quantity_values& parameters, const std::string& name, double low, double high) {
  const double value = number_of(parameters.at(name));
  if (!(value >= low && value <= high))
    throw input_error(
        fmt::format("{} = '{}' is not a number from {} to {} (the parameter has no other values); write for "
                    "example {}={}",
                    name, parameters.at(name).substr(0, 60), low, high, name, value > high ? high : low));
  return value;
}

const std::string& one_of(const quantity_values& parameters, const std::string& name,
                          const std::vector<std::string>& words) {
  const std::string& text = parameters.at(name);
  if (std::find(words.begin(), words.end(), text) == words.end())
    throw input_error(fmt::format("{} = '{}' is unknown (the quantity has no such choice); {}", name,
                                  text.substr(0, 60), suggest(text, words)));
  return text;
}

std::vector<double> field_values(const simulation& run, const std::string& name) {
  const field_table fields = run.fields();
  return fields.values.at(place_in(fields.names, name));
}

double mean_of_field(const simulation& run, const std::string& name) {
  return mean_of_cells(field_values(run, name), run.fields().shape);
}

double mean_of_cells(std::vector<double> values, const std::vector<int>& shape) {
  for (std::size_t axis = shape.size(); axis-- > 0;)
    values = means_of_lines(values, static_cast<std::size_t>(shape[axis]));
  return values.front();
}

double last_flux(const simulation& run, const std::string& face, const std::string& invariant) {
  const auto invariants = run.setup().equation->invariants();
  const std::size_t at =
      place_in(run.setup().open_faces(), face) * invariants.size() + place_in(invariants, invariant);
  return run.last().flux.at(at);
}

std::map<std::string, std::vector<double>> wall_values(const simulation& run, const std::string& surface) {
  for (const surface_table& table : run.surfaces()) {
    if (table.name != surface) continue;
    std::map<std::string, std::vector<double>> columns;
    for (const auto& row : table.numbers.rows)
      for (std::size_t k = 0; k < row.size(); ++k) columns[table.numbers.columns[k]].push_back(row[k]);
    return columns;
  }
  throw std::out_of_range("no table of '" + surface + "' in the run");
}

}  // namespace apsis::validation
