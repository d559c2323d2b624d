#pragma once

#include <apsis/integrate/lanes.hpp>

#include <array>
#include <cstddef>

namespace apsis::lane_arithmetic {

/// A number and its derivatives with respect to N unknowns, in lanes: x + Σ x_i s_i with s_i s_j = 0. One
/// evaluation of a function on jets gives its value and all columns of its derivative.
template <std::size_t N>
struct jet {
  lanes value;              ///< x
  std::array<lanes, N> by;  ///< x_i

  /// Undefined numbers.
  jet() = default;
  /// A constant.
  jet(const lanes& x) : value(x) { by.fill(0.0); }
  /// A constant.
  jet(double x) : jet(lanes(x)) {}

  /// f(x), given f and f′ at x.
  jet through(const lanes& f, const lanes& slope) const {
    return combine([&](std::size_t i) { return slope * by[i]; }, f);
  }

  /// −x
  friend jet operator-(const jet& x) {
    return combine([&](std::size_t i) { return -x.by[i]; }, -x.value);
  }
  /// x + y
  friend jet operator+(const jet& x, const jet& y) {
    return combine([&](std::size_t i) { return x.by[i] + y.by[i]; }, x.value + y.value);
  }
  /// x − y
  friend jet operator-(const jet& x, const jet& y) {
    return combine([&](std::size_t i) { return x.by[i] - y.by[i]; }, x.value - y.value);
  }
  /// xy
  friend jet operator*(const jet& x, const jet& y) {
    return combine([&](std::size_t i) { return x.by[i] * y.value + x.value * y.by[i]; }, x.value * y.value);
  }
  /// x/y
  friend jet operator/(const jet& x, const jet& y) {
    const lanes part = lanes(1.0) / y.value, ratio = x.value * part;
    return combine([&](std::size_t i) { return (x.by[i] - ratio * y.by[i]) * part; }, ratio);
  }
  /// ax
  friend jet operator*(const lanes& a, const jet& x) { return x.through(a * x.value, a); }
  /// ax
  friend jet operator*(const jet& x, const lanes& a) { return a * x; }
  /// x/a
  friend jet operator/(const jet& x, const lanes& a) { return (lanes(1.0) / a) * x; }
  /// x/a
  friend jet operator/(const jet& x, double a) { return x / lanes(a); }
  /// ax
  friend jet operator*(double a, const jet& x) { return lanes(a) * x; }
  /// ax
  friend jet operator*(const jet& x, double a) { return lanes(a) * x; }

  /// eˣ
  friend jet exp(const jet& x) {
    const lanes f = exp(x.value);
    return x.through(f, f);
  }
  /// ln x
  friend jet log(const jet& x) { return x.through(log(x.value), lanes(1.0) / x.value); }
  /// √x
  friend jet sqrt(const jet& x) {
    const lanes f = sqrt(x.value);
    return x.through(f, lanes(0.5) / f);
  }
  /// sin x
  friend jet sin(const jet& x) { return x.through(sin(x.value), cos(x.value)); }
  /// cos x
  friend jet cos(const jet& x) { return x.through(cos(x.value), -sin(x.value)); }
  /// xⁿ
  friend jet pow(const jet& x, double n) {
    return x.through(pow(x.value, n), lanes(n) * pow(x.value, n - 1.0));
  }

 private:
  template <class Part>
  static jet combine(const Part& part, const lanes& value) {
    jet x;
    x.value = value;
    for (std::size_t i = 0; i < N; ++i) x.by[i] = part(i);
    return x;
  }
};

}  // namespace apsis::lane_arithmetic

namespace apsis {
using lane_arithmetic::jet;
}  // namespace apsis
