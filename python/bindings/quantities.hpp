#pragma once

#include "callback.hpp"

#include <apsis/velocity/position.hpp>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace apsis::python {

/// A function of the user that threads of a step call: every call takes the GIL, and so does its destruction.
class shared_callback {
 public:
  /// `name`: that of the argument, for messages. Needs the GIL.
  shared_callback(py::function function, std::string name);

  /// Returns function(t, x, …, v_x, …) with the coordinates of a point and, of a function of the velocity,
  /// its components.
  double at(double t, std::span<const double> x, std::span<const double> v = {}) const;

 private:
  std::shared_ptr<const callback> held_;
};

/// A number, or a function of t and x that threads may call.
struct quantity_in_time {
  double number = 0.0;                                      ///< where there is no function
  std::function<double(double, const position&)> function;  ///< empty for a number
};

/// Returns a number or function of Python; `name` is that of the argument. Throws input_error for other
/// values. Needs the GIL.
quantity_in_time to_quantity(const py::handle& given, const std::string& name, int dimensions);

}  // namespace apsis::python
