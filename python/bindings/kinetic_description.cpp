#include "callback.hpp"
#include "kinetic_description.hpp"
#include "quantities.hpp"

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace apsis::python {
namespace {

/// A function of t, x and v of Python.
face_quantity velocity_function(const py::handle& given, const std::string& name, const model& equation) {
  const shared_callback function(py::reinterpret_borrow<py::function>(given), name);
  const auto space = static_cast<std::size_t>(equation.space_dimensions()),
             velocity = static_cast<std::size_t>(equation.velocities().dimensions());
  return {[function, space, velocity](double t, const position& x, const position& v) {
    return function.at(t, std::span(x).first(space), std::span(v).first(velocity));
  }};
}

}  // namespace

std::unique_ptr<model> make_equation(const kinetic_description& of) {
  const model_entry& entry = find_model(of.model);
  model_config config = default_config(entry);
  for (const auto& given : of.parameters) {
    const std::string& name = given.first;
    const double value = given.second;
    if (!config.parameters.contains(name))
      throw input_error(
          fmt::format("unknown parameter '{1}' (model '{0}' has no such parameter); see: apsis list models",
                      of.model, name));
    const auto p = std::find_if(entry.parameters.begin(), entry.parameters.end(),
                                [&name](const auto& one) { return one.name == name; });
    if (!(value >= p->lowest && value <= p->highest) || (p->integer && value != std::floor(value)))
      throw input_error(fmt::format("{} = {:g} is out of range ({} from {:g} to {:g} is needed); change it",
                                    name, value, p->integer ? "an integer" : "a number", p->lowest,
                                    p->highest));
    config.parameters[name] = value;
  }
  for (const auto& [name, value] : of.options) {
    if (!config.options.contains(name))
      throw input_error(fmt::format(
          "unknown option '{1}' (model '{0}' has no such option); see: apsis list models", of.model, name));
    config.options[name] = value;
  }
  for (const auto& [name, value] : of.lists) {
    if (!config.lists.contains(name))
      throw input_error(fmt::format(
          "unknown list '{1}' (model '{0}' has no such list); see: apsis list models", of.model, name));
    config.lists[name] = value;
  }
  if (entry.has_velocity_grid) {
    config.velocity = {of.velocity_max, of.velocity_points,
                       choice_called<equilibrium_choice>("equilibrium", of.equilibrium), of.velocity_sets};
    for (const auto& line : of.velocity_lines) config.velocity.lines.emplace_back(line.first, line.second);
  }
  return entry.make(config);
}

std::shared_ptr<const boundary> make_face(const given_face& of, const model& equation,
                                          const std::string& name) {
  face_quantities values;
  for (const auto& [key, list] : of.second) {
    const std::string variable = py::str(key);
    const std::string own = fmt::format("{}['{}']", name, variable);
    const auto known = variable_of(of.first, equation, variable);
    const bool of_velocity = known && known->of_velocity;
    for (const auto item : list) {
      if (of_velocity && PyCallable_Check(item.ptr()) != 0) {
        values[variable].push_back(velocity_function(item, own, equation));
        continue;
      }
      quantity_in_time value =
          to_quantity(item, own, known && known->over_surface ? 0 : equation.space_dimensions());
      values[variable].push_back(value.function ? face_quantity(std::move(value.function))
                                                : face_quantity(value.number));
    }
  }
  return make_boundary(of.first, equation, values);
}

std::optional<acceleration> make_acceleration(const kinetic_description& of, const model& equation) {
  if (of.acceleration.empty()) return std::nullopt;
  const auto possible = static_cast<std::size_t>(equation.velocities().dimensions());
  if (of.acceleration.size() > possible)
    throw input_error(
        fmt::format("acceleration has {} components (the model has {} velocity dimensions); give {}",
                    of.acceleration.size(), possible, possible));
  const auto& bounds = of.largest_acceleration;
  if (bounds.size() > 1 && bounds.size() != of.acceleration.size())
    throw input_error(
        fmt::format("largest_acceleration has {} components and acceleration {}; give one for each",
                    bounds.size(), of.acceleration.size()));
  acceleration force;
  std::vector<quantity_in_time> components;
  for (std::size_t k = 0; k < of.acceleration.size(); ++k) {
    components.push_back(to_quantity(of.acceleration[k], "acceleration", equation.space_dimensions()));
    if (components[k].function && bounds.empty())
      throw input_error(
          "largest_acceleration is missing (acceleration is a function, whose largest value limits the "
          "step); "
          "give a bound of |acceleration|");
    force.largest[k] = components[k].function ? bounds.size() == 1 ? bounds.front() : bounds[k]
                                              : std::abs(components[k].number);
  }
  force.value = [components](double t, const position& x) {
    std::array<double, 3> a{};
    for (std::size_t k = 0; k < components.size(); ++k)
      a[k] = components[k].function ? components[k].function(t, x) : components[k].number;
    return a;
  };
  return force;
}

grid make_grid(const kinetic_description& of) {
  std::array<int, 3> cells = {1, 1, 1};
  std::array<double, 3> lower{}, upper = {1.0, 1.0, 1.0};
  for (std::size_t k = 0; k < std::min<std::size_t>(of.cells.size(), 3); ++k) {
    cells[k] = of.cells[k];
    lower[k] = of.domain[k][0];
    upper[k] = of.domain[k][1];
  }
  return {static_cast<int>(of.cells.size()), cells, lower, upper};
}

}  // namespace apsis::python
