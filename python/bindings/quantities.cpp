#include "quantities.hpp"

#include <apsis/core/errors.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace apsis::python {

shared_callback::shared_callback(py::function function, std::string name)
    : held_(new callback(std::move(function), std::move(name)), [](const callback* of) {
        const py::gil_scoped_acquire python;
        delete of;
      }) {}

double shared_callback::at(double t, std::span<const double> x, std::span<const double> v) const {
  const py::gil_scoped_acquire python;
  const py::tuple arguments(1 + x.size() + v.size());
  arguments[0] = t;
  for (std::size_t k = 0; k < x.size(); ++k) arguments[1 + k] = x[k];
  for (std::size_t k = 0; k < v.size(); ++k) arguments[1 + x.size() + k] = v[k];
  const double value = held_->number((*held_)(*arguments));
  if (!std::isfinite(value))
    throw input_error(fmt::format("{} returned {} at t = {:.10g} (a finite number is needed); return one",
                                  held_->name(), value, t));
  return value;
}

quantity_in_time to_quantity(const py::handle& given, const std::string& name, int dimensions) {
  const auto object = py::reinterpret_borrow<py::object>(given);
  if (PyCallable_Check(given.ptr()) != 0) {
    const shared_callback function(py::reinterpret_borrow<py::function>(object), name);
    const auto count = static_cast<std::size_t>(dimensions);
    return {0.0, [function, count](double t, const position& x) {
              return function.at(t, std::span(x).first(count));
            }};
  }
  const double value = py::isinstance<py::str>(given) ? std::nan("") : PyFloat_AsDouble(given.ptr());
  if (PyErr_Occurred() != nullptr) PyErr_Clear();
  if (!std::isfinite(value) || py::isinstance<py::bool_>(given))
    throw input_error(fmt::format("{} is {} (a finite number or a function of t and x is needed); give one",
                                  name, std::string(py::repr(object)).substr(0, 60)));
  return {value, {}};
}

}  // namespace apsis::python
