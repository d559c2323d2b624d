#include "callback.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace apsis::python {
namespace {

using real_array = py::array_t<double, py::array::c_style>;

std::string shape_text(const std::vector<py::ssize_t>& shape) {
  return py::str(py::tuple(py::cast(shape)));
}

std::vector<py::ssize_t> shape_of(const py::array& a) {
  return {a.shape(), a.shape() + a.ndim()};
}

/// "an array of shape (3,) and type complex128", "None", "a value of type str".
std::string type_and_size(const py::object& value) {
  if (value.is_none()) return "None";
  if (py::isinstance<py::array>(value)) {
    const auto a = value.cast<py::array>();
    return fmt::format("an array of shape {} and type {}", shape_text(shape_of(a)),
                       std::string(py::str(a.dtype())));
  }
  return fmt::format("a value of type {}", std::string(py::str(py::type::of(value).attr("__name__"))));
}

/// Text, bytes and objects are not numbers, even where NumPy would convert them; nor are complex values,
/// whose imaginary part it would drop, nor None, for which it writes NaN. Numbers of other classes, such as
/// Fraction, have __float__.
real_array real_numbers(const py::object& value) {
  const py::module_ numpy = py::module_::import("numpy");
  const py::array plain = numpy.attr("asarray")(value);
  const char kind = plain.dtype().kind();
  const py::object wanted = numpy.attr("float64");
  if (kind == 'b' || kind == 'i' || kind == 'u' || kind == 'f')
    return numpy.attr("ascontiguousarray")(plain, wanted).cast<real_array>();
  if (kind != 'O') throw py::type_error("not real numbers");
  py::list numbers;
  for (const auto item : plain.attr("ravel")())
    numbers.append(py::float_(py::reinterpret_borrow<py::object>(item)));
  return numpy.attr("array")(numbers, wanted).attr("reshape")(plain.attr("shape")).cast<real_array>();
}

}  // namespace

void callback::refuse(const py::object& returned, const std::string& wanted) const {
  throw input_error(
      fmt::format("{} returned {} ({} is needed); return that", name_, type_and_size(returned), wanted));
}

void callback::refuse(py::error_already_set& why, const py::object& returned,
                      const std::string& wanted) const {
  if (!why.matches(PyExc_TypeError) && !why.matches(PyExc_ValueError)) throw why;
  const py::object type = py::module_::import("apsis.errors").attr("InputError");
  const auto message =
      fmt::format("{} returned {} ({} is needed); return that", name_, type_and_size(returned), wanted);
  py::raise_from(why, type.ptr(), message.c_str());
  throw py::error_already_set();
}

void callback::numbers(const py::object& returned, const std::vector<py::ssize_t>& shape,
                       std::span<double> out) const {
  const auto wanted = [&] {
    return fmt::format("an array of real numbers of the shape of u, {},", shape_text(shape));
  };
  if (returned.is_none()) refuse(returned, wanted());
  real_array found;
  try {
    // Most functions return what is needed, and it is looked at without a copy.
    found = py::isinstance<real_array>(returned) ? returned.cast<real_array>() : real_numbers(returned);
  } catch (py::error_already_set& why) {
    refuse(why, returned, wanted());
  } catch (const py::type_error&) {
    refuse(returned, wanted());
  }
  if (shape_of(found) != shape && !(found.size() == 1 && out.size() == 1)) refuse(found, wanted());
  std::copy_n(found.data(), out.size(), out.data());
}

void callback::broadcast(const py::object& returned, const std::vector<py::ssize_t>& shape,
                         std::span<double> out) const {
  const auto wanted = [&] {
    return fmt::format("a real number, or an array that NumPy broadcasts to the shape of u, {},",
                       shape_text(shape));
  };
  if (returned.is_none()) refuse(returned, wanted());
  try {
    const py::object all = py::module_::import("numpy").attr("broadcast_to")(real_numbers(returned), shape);
    const real_array found = all.cast<real_array>();
    std::copy_n(found.data(), out.size(), out.data());
  } catch (py::error_already_set& why) {
    refuse(why, returned, wanted());
  } catch (const py::type_error&) {
    refuse(returned, wanted());
  }
}

double callback::number(const py::object& returned) const {
  const double value = PyFloat_AsDouble(returned.ptr());
  if (value == -1.0 && PyErr_Occurred() != nullptr) {
    py::error_already_set why;
    refuse(why, returned, "one real number");
  }
  return value;
}

bool callback::truth(const py::object& returned) const {
  const int value = PyObject_IsTrue(returned.ptr());
  if (value < 0) {
    py::error_already_set why;
    refuse(why, returned, "True or False");
  }
  if (returned.is_none()) refuse(returned, "True or False");
  return value == 1;
}

py::object callback::something(py::object returned) const {
  if (returned.is_none()) refuse(returned, "a value");
  return returned;
}

}  // namespace apsis::python
