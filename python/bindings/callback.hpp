#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace apsis::python {

namespace py = pybind11;

/// A function of the user with the name of its parameter ("transport"), and the checks of what it returns.
/// Exceptions of the function itself, KeyboardInterrupt included, leave as they are. A value that cannot be
/// used is an apsis.InputError that names the function, says what it returned, and has the exception of the
/// conversion as its cause.
class callback {
 public:
  callback(py::function function, std::string name)
      : function_(std::move(function)), name_(std::move(name)) {}

  /// Returns the result of the function.
  template <class... Arguments>
  py::object operator()(Arguments&&... arguments) const {
    return function_(std::forward<Arguments>(arguments)...);
  }

  /// Returns the name of the parameter.
  const std::string& name() const { return name_; }
  /// `returned` as real numbers of this shape, in C order. One number may come in any shape of one element.
  void numbers(const py::object& returned, const std::vector<py::ssize_t>& shape,
               std::span<double> out) const;
  /// `returned` as real numbers of this shape; an array of another shape is repeated as NumPy broadcasts it.
  void broadcast(const py::object& returned, const std::vector<py::ssize_t>& shape,
                 std::span<double> out) const;
  /// `returned` as one real number.
  double number(const py::object& returned) const;
  /// `returned` as a truth value.
  bool truth(const py::object& returned) const;
  /// Refuses None, which is what a function without `return` returns.
  py::object something(py::object returned) const;

 private:
  [[noreturn]] void refuse(const py::object& returned, const std::string& wanted) const;
  /// The same, with the exception that is being handled as the cause unless it is of another kind than a
  /// conversion has: then that exception.
  [[noreturn]] void refuse(py::error_already_set& why, const py::object& returned,
                           const std::string& wanted) const;

  py::function function_;
  std::string name_;
};

/// The callback of a function that may be missing.
inline std::optional<callback> optional_callback(const std::optional<py::function>& function,
                                                 const char* name) {
  if (!function) return std::nullopt;
  return callback(*function, name);
}

}  // namespace apsis::python
