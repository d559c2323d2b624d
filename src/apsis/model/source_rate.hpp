#pragma once

#include <apsis/velocity/position.hpp>

#include <functional>
#include <span>

namespace apsis {

/// A source S(t, x, u) of rows, per unit of time. Dimensionless.
struct source_rate {
  /// row ← S at a time, a point of space and the row `u` there. `u` may be empty if S does not depend on
  /// it. Thread-safe.
  std::function<void(double t, const position& x, std::span<const double> u, std::span<double> row)> value;
  bool steady = false;  ///< whether S depends neither on t nor on u
  /// Returns a bound on |∂S/∂u| with variables in units of their sizes. Empty if S does not depend on u.
  std::function<double(double t, const position& x, std::span<const double> u)> growth = {};
};

}  // namespace apsis
