#pragma once

#include <apsis/phase/position.hpp>

#include <functional>
#include <span>

namespace apsis {

/// A source S(t, x) of rows, per unit of time. Dimensionless.
struct source_rate {
  /// row ← S at a time and a point of space; concurrent calls are possible.
  std::function<void(double t, const position& x, std::span<double> row)> value;
  bool steady = false;  ///< S does not depend on t
};

}  // namespace apsis
