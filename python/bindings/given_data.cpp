#include "arrays.hpp"
#include "callback.hpp"
#include "given_data.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>

namespace apsis::python {
namespace {

py::tuple coordinates(const position& x, int dimensions) {
  py::tuple all(static_cast<std::size_t>(dimensions));
  for (int k = 0; k < dimensions; ++k) all[static_cast<std::size_t>(k)] = x[static_cast<std::size_t>(k)];
  return all;
}

std::string position_text(const position& x, int dimensions) {
  std::vector<std::string> parts;
  for (int k = 0; k < dimensions; ++k)
    parts.push_back(fmt::format("{} = {:.10g}", "xyz"[k], x[static_cast<std::size_t>(k)]));
  return dimensions == 0 ? "" : fmt::format(" at {}", fmt::join(parts, ", "));
}

std::string shape_text(const py::array& a) {
  return fmt::format("({}{})", fmt::join(a.shape(), a.shape() + a.ndim(), ", "), a.ndim() == 1 ? "," : "");
}

/// Real numbers as an array. Throws input_error for others.
array numbers_of(const py::object& given, const std::string& name) {
  const py::object check = py::module_::import("apsis.arguments").attr("real_array");
  return check(name, given).cast<array>();
}

/// Velocities as arguments of a function: an array of each component, v_x, v_y, v_z, with `count` numbers.
py::tuple velocity_arguments(const velocity_set& set, int count) {
  py::tuple all(static_cast<std::size_t>(set.dimensions()));
  for (int k = 0; k < set.dimensions(); ++k) {
    const auto speeds = set.speeds(k).first(static_cast<std::size_t>(count));
    all[static_cast<std::size_t>(k)] =
        to_fixed_array(std::vector<double>(speeds.begin(), speeds.end()), {count});
  }
  return all;
}

/// A variable of `size` components: numbers, a function, or values of cells. `v`: the further arguments of
/// functions, nothing unless it is a function of the velocity, whose components are its values there.
class given_variable {
 public:
  given_variable(const py::object& given, int size, int cells, std::string name, py::tuple v = py::tuple(0))
      : name_(std::move(name)), size_(size), velocity_(std::move(v)) {
    if (PyCallable_Check(given.ptr()) != 0) {
      functions_.emplace_back(py::reinterpret_borrow<py::function>(given), name_);
      return;
    }
    const bool list = py::isinstance<py::list>(given) || py::isinstance<py::tuple>(given);
    if (size > 1 && list && has_function(given))
      take_components(given, cells);
    else
      take_numbers(numbers_of(given, name_), cells);
  }

  bool of_cells() const {
    return of_cells_ ||
           std::any_of(parts_.begin(), parts_.end(), [](const auto& one) { return one.of_cells(); });
  }
  bool has_functions() const {
    return !functions_.empty() ||
           std::any_of(parts_.begin(), parts_.end(), [](const auto& one) { return one.has_functions(); });
  }
  const std::string& name() const { return name_; }

  /// Appends the components at a point, or of a cell.
  void append(const position& x, int dimensions, int cell, std::vector<double>& out) const {
    if (!parts_.empty()) {
      for (const auto& part : parts_) part.append(x, dimensions, cell, out);
      return;
    }
    std::vector<double> values(static_cast<std::size_t>(size_));
    if (!functions_.empty()) {
      const callback& function = functions_.front();
      const py::tuple arguments = coordinates(x, dimensions) + velocity_;
      const py::object returned = function(*arguments);
      if (size_ == 1)
        values[0] = function.number(returned);
      else
        function.numbers(returned, {size_}, values);
    } else {
      const std::size_t first = of_cells_ ? static_cast<std::size_t>(cell) * values.size() : 0;
      std::copy_n(numbers_.begin() + static_cast<std::ptrdiff_t>(first), size_, values.begin());
    }
    out.insert(out.end(), values.begin(), values.end());
  }

 private:
  static bool has_function(const py::object& list) {
    for (const auto item : list)
      if (PyCallable_Check(item.ptr()) != 0) return true;
    return false;
  }

  void take_components(const py::object& list, int cells) {
    if (static_cast<int>(py::len(list)) != size_)
      throw input_error(fmt::format("{} has {} components (the model has {}); give {}", name_, py::len(list),
                                    size_, size_));
    for (const auto item : list)
      parts_.emplace_back(py::reinterpret_borrow<py::object>(item), 1, cells,
                          fmt::format("{}[{}]", name_, parts_.size()));
  }

  /// One number is the component along x, or the value at all velocities.
  void take_numbers(const array& given, int cells) {
    const std::vector<py::ssize_t> shape(given.shape(), given.shape() + given.ndim());
    using extents = std::vector<py::ssize_t>;
    if (shape.empty() || (size_ > 1 && shape == extents{size_})) {
      numbers_.assign(given.data(), given.data() + given.size());
    } else if ((size_ == 1 && shape == extents{cells}) || shape == extents{cells, size_}) {
      numbers_.assign(given.data(), given.data() + given.size());
      of_cells_ = true;
    } else {
      throw input_error(
          fmt::format("{} has the shape {} (that of the cells is {}); give a number, a function, or one "
                      "value for each cell",
                      name_, shape_text(given),
                      size_ == 1 ? fmt::format("({},)", cells) : fmt::format("({}, {})", cells, size_)));
    }
    const double others = velocity_.empty() ? 0.0 : numbers_.front();
    numbers_.resize(std::max(numbers_.size(), static_cast<std::size_t>(size_)), others);
  }

  std::string name_;
  int size_;
  py::tuple velocity_;
  bool of_cells_ = false;
  std::vector<double> numbers_;
  std::vector<callback> functions_;    ///< at most one
  std::vector<given_variable> parts_;  ///< components, each given in its own way
};

/// The first form with all given variables that lacks none without a default.
data_form form_of(const std::set<std::string>& given, const std::vector<data_form>& forms,
                  const std::string& name) {
  std::vector<std::string> known;
  std::optional<std::string> missing;
  for (const auto& form : forms) {
    std::set<std::string> unused = given;
    std::optional<std::string> lacks;
    for (const auto& variable : form.variables) {
      known.push_back(variable.name);
      if (unused.erase(variable.name) == 0 && !variable.value && !lacks)
        lacks =
            fmt::format("'{}' is missing in {} (it is the {}); add it", variable.name, name, variable.doc);
    }
    if (unused.empty() && !lacks) return form;
    if (unused.empty() && !missing) missing = lacks;
  }
  if (missing) throw input_error(*missing);
  for (const auto& one : given)
    if (std::find(known.begin(), known.end(), one) == known.end())
      throw input_error(fmt::format("unknown variable '{}' in {} (the model has no such variable); {}",
                                    one.substr(0, 60), name, suggest(one, known)));
  throw input_error(fmt::format("the variables {} in {} do not belong together; leave some out",
                                fmt::join(given, ", "), name));
}

class variables_sampler {
 public:
  variables_sampler(const py::dict& given, const model& equation, const problem_builder& builder,
                    std::string name)
      : equation_(equation), builder_(builder), name_(std::move(name)) {
    std::set<std::string> names;
    for (const auto& [key, value] : given) names.insert(std::string(py::str(key)));
    form_ = form_of(names, equation.data_forms(), name_);
    for (const auto& variable : form_.variables) {
      py::object value = py::cast(
          std::vector<double>(static_cast<std::size_t>(variable.size), variable.value.value_or(0.0)));
      if (variable.size == 1) value = py::float_(variable.value.value_or(0.0));
      if (given.contains(variable.name)) value = given[variable.name.c_str()];
      const velocity_set& set = equation.velocities();
      variables_.emplace_back(value, variable.of_velocity ? set.size() : variable.size, builder.mesh().size(),
                              fmt::format("{}['{}']", name_, variable.name),
                              variable.of_velocity ? velocity_arguments(set, set.size()) : py::tuple(0));
    }
  }

  field sample(const std::vector<double>& jumps) const {
    const auto cells = find(&given_variable::of_cells), functions = find(&given_variable::has_functions);
    if (cells != variables_.end() && functions != variables_.end())
      throw input_error(
          fmt::format("{} has a value for each cell and {} is a function (cell averages of both together "
                      "are not known); give arrays only, or functions only",
                      cells->name(), functions->name()));
    if (cells == variables_.end())
      return builder_.sample([this](const position& x, std::span<double> u) { row(x, -1, u); }, jumps);
    field u(builder_.mesh().size(), equation_.components());
    for (int cell = 0; cell < u.cells(); ++cell)
      row({}, cell, {u.row(cell), static_cast<std::size_t>(u.components())});
    return u;
  }

 private:
  std::vector<given_variable>::const_iterator find(bool (given_variable::*has)() const) const {
    return std::find_if(variables_.begin(), variables_.end(),
                        [has](const auto& one) { return (one.*has)(); });
  }

  void row(const position& x, int cell, std::span<double> u) const {
    const int dimensions = equation_.space_dimensions();
    std::vector<double> numbers;
    for (const auto& variable : variables_) variable.append(x, dimensions, cell, numbers);
    const std::string problem = form_.row(numbers, u);
    if (!problem.empty())
      throw input_error(
          fmt::format("{} has no {}{} ({}); change the data", name_, form_.description,
                      cell < 0 ? position_text(x, dimensions) : fmt::format(" in cell {}", cell), problem));
  }

  const model& equation_;
  const problem_builder& builder_;
  std::string name_;
  data_form form_;
  std::vector<given_variable> variables_;
};

field sample_function(const py::function& given, const model& equation, const problem_builder& builder,
                      const std::vector<double>& jumps, const std::string& name) {
  const callback function(given, name);
  const int dimensions = equation.space_dimensions();
  const bool of_velocities = !equation.lattice().points.empty();
  const velocity_set& set = equation.velocities();
  const py::tuple v = of_velocities ? velocity_arguments(set, set.components()) : py::tuple(0);
  std::vector<double> row(static_cast<std::size_t>(equation.components()));
  return builder.sample(
      [&](const position& x, std::span<double> u) {
        const py::tuple arguments = coordinates(x, dimensions) + v;
        function.numbers(function(*arguments), {equation.components()}, row);
        if (!std::all_of(row.begin(), row.end(), [](double one) { return std::isfinite(one); }))
          throw input_error(fmt::format("{} is not finite{}; change it", name, position_text(x, dimensions)));
        std::copy(row.begin(), row.end(), u.begin());
      },
      jumps);
}

field copy_state(const array& given, const model& equation, const problem_builder& builder,
                 const std::string& name) {
  field u(builder.mesh().size(), equation.components());
  const std::vector<py::ssize_t> shape(given.shape(), given.shape() + given.ndim());
  const std::vector<py::ssize_t> wanted = {u.cells(), u.components()};
  const bool point = equation.space_dimensions() == 0 && shape == std::vector<py::ssize_t>{u.components()};
  if (shape != wanted && !point)
    throw input_error(
        fmt::format("{} has the shape {} (that of a state is ({}, {})); give [cells, components]", name,
                    shape_text(given), wanted[0], wanted[1]));
  for (int cell = 0; cell < u.cells(); ++cell) {
    const double* row = given.data() + static_cast<std::ptrdiff_t>(cell) * u.components();
    if (!std::all_of(row, row + u.components(), [](double one) { return std::isfinite(one); }))
      throw input_error(fmt::format("{} is not finite in cell {}; change it", name, cell));
    std::copy_n(row, u.components(), u.row(cell));
  }
  return u;
}

}  // namespace

field make_state(const py::object& given, const model& equation, const problem_builder& builder,
                 const std::vector<double>& jumps, const std::string& name) {
  if (py::isinstance<py::dict>(given))
    return variables_sampler(given.cast<py::dict>(), equation, builder, name).sample(jumps);
  if (PyCallable_Check(given.ptr()) != 0)
    return sample_function(py::reinterpret_borrow<py::function>(given), equation, builder, jumps, name);
  return copy_state(numbers_of(given, name), equation, builder, name);
}

}  // namespace apsis::python
