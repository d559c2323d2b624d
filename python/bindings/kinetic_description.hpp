#pragma once

#include <apsis/boundary/boundary.hpp>
#include <apsis/config/choices.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/model/acceleration.hpp>
#include <apsis/model/model_registry.hpp>

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pybind11/pybind11.h>

namespace apsis::python {

namespace py = pybind11;

/// Returns the value of an enumeration of a case by its name. Throws input_error with the nearest name.
template <class Choice>
Choice choice_called(const std::string& what, const std::string& name) {
  const auto& names = choice_names<Choice>;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (name == names[k]) return static_cast<Choice>(k);
  throw input_error(fmt::format("unknown {} '{}' (there is no such name); {}", what, name.substr(0, 60),
                                suggest(name, {names.begin(), names.end()})));
}

/// A boundary: its kind, and the values of its variables, lists of numbers and functions.
using given_face = std::pair<std::string, py::dict>;
/// Velocities and weights of a direction.
using given_line = std::pair<std::vector<double>, std::vector<double>>;

/// Description of a problem by names and numbers.
struct kinetic_description {
  std::string model;
  std::map<std::string, double> parameters;
  std::map<std::string, std::string> options;
  std::map<std::string, std::vector<std::string>> lists;
  double velocity_max;
  std::vector<int> velocity_points;
  std::vector<std::string> velocity_sets;
  std::vector<given_line> velocity_lines;
  std::string equilibrium;
  std::vector<int> cells;
  std::vector<std::array<double, 2>> domain;
  std::vector<std::array<given_face, 2>> boundary;
  std::vector<py::object> acceleration;      ///< numbers and functions
  std::vector<double> largest_acceleration;  ///< of functions; empty if unknown
  std::string reconstruction, discretization, collisions;
  bool positivity;
};

/// Returns the model. Throws input_error for names that it does not have and numbers out of range.
std::unique_ptr<model> make_equation(const kinetic_description& of);
/// Returns the mesh.
grid make_grid(const kinetic_description& of);
/// Returns the boundary of a face; `name` is that of its argument.
std::shared_ptr<const boundary> make_face(const given_face& of, const model& equation,
                                          const std::string& name);
/// Returns the acceleration; nothing if none is given. Throws input_error for other numbers of components
/// than velocity dimensions, and for functions without a bound.
std::optional<acceleration> make_acceleration(const kinetic_description& of, const model& equation);

}  // namespace apsis::python
