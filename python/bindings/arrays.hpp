#pragma once

#include <apsis/core/matrix.hpp>

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace apsis::python {

namespace py = pybind11;
using array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// An array that owns the numbers: nothing is copied.
inline py::array_t<double> to_array(std::vector<double>&& numbers, std::vector<py::ssize_t> shape) {
  auto owner = std::make_unique<std::vector<double>>(std::move(numbers));
  const double* data = owner->data();
  const py::capsule keeper(owner.get(), [](void* v) { delete static_cast<std::vector<double>*>(v); });
  static_cast<void>(owner.release());  // NOLINT(bugprone-unused-return-value): the capsule owns it
  return py::array_t<double>(std::move(shape), data, keeper);
}

inline py::array_t<double> to_array(std::vector<double>&& numbers) {
  const auto n = static_cast<py::ssize_t>(numbers.size());
  return to_array(std::move(numbers), {n});
}

inline py::array_t<double> to_array(const matrix<double>& m) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < m.rows(); ++i)
    for (std::size_t j = 0; j < m.cols(); ++j) numbers.push_back(m(i, j));
  return to_array(std::move(numbers),
                  {static_cast<py::ssize_t>(m.rows()), static_cast<py::ssize_t>(m.cols())});
}

/// A copy that cannot be written to. A function may keep what it is given, and the state of an integration
/// moves on.
inline py::array_t<double> to_fixed_array(std::span<const double> numbers,
                                          const std::vector<py::ssize_t>& shape) {
  py::array_t<double> copy(shape, numbers.data());
  copy.attr("setflags")(py::arg("write") = false);
  return copy;
}

void bind_errors(py::module_& m);
void bind_warnings(py::module_& m);
void bind_methods(py::module_& m);
void bind_integrate(py::module_& m);
void bind_general(py::module_& m);
void bind_evolution(py::module_& m);
void bind_runs(py::module_& m);
void bind_kinetic(py::module_& m);

}  // namespace apsis::python
