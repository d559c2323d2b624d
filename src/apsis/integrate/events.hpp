#pragma once

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// Functions g_k(t, u) of the solution; a zero is an event.
template <class State, class Real>
struct event_functions {
  std::size_t count = 0;  ///< number of functions
  /// Sets g[k] ← g_k(t, u) for every k.
  std::function<void(Real t, const State& u, std::span<Real> g)> evaluate;
  std::vector<int> directions{};  ///< of each: 1 for increasing g, −1 for decreasing, 0 for both; empty: both
  std::vector<bool> ends{};       ///< of each: whether an event ends the integration; empty: it does

  /// Whether a change of g_k from one sign to another is an event; a sign is −1, 0 or 1. g_k = 0 is an event
  /// unless g_k was 0 before.
  bool is_event(std::size_t k, int before, int after) const {
    if (before == 0 || before == after) return false;
    return directions.empty() || directions[k] == 0 || (directions[k] > 0) == (before < 0);
  }
  /// Whether an event of g_k ends the integration.
  bool is_last(std::size_t k) const { return ends.empty() || ends[k]; }
};

/// An event.
template <class Real>
struct found_event {
  std::size_t function;  ///< k, from 0
  Real t;                ///< its time
};

/// Returns the sign of g_k, −1, 0 or 1. Throws numerical_error if it is NaN.
template <class Real>
int sign_of_event(std::size_t k, Real g, Real t) {
  if (std::isnan(g))
    throw numerical_error("event function " + std::to_string(k) + " is NaN; check the function",
                          {-1, static_cast<double>(t), -1, std::numeric_limits<double>::quiet_NaN()});
  return g > Real(0) ? 1 : g < Real(0) ? -1 : 0;
}

/// Returns a time at most `width` > 0 after a change of the sign of g between a and b. At this time g does
/// not have the sign of g_a. Requires g(a) = g_a ≠ 0 and g(b) = g_b of another sign; g need not be
/// continuous. Uses the Illinois method (Dowell, Jarratt, BIT 11 (1971) 168–174), with bisection where this
/// is slow.
template <class Real, class G>
Real time_after_sign_change(const G& g, Real a, Real g_a, Real b, Real g_b, Real width) {
  const bool positive = g_a > Real(0);
  int last = 0, slow = 0;  // side that moved last; iterations since the bracket was halved
  Real halved = b - a;
  while (b - a > width && g_b != Real(0)) {
    Real c = slow >= 3 ? a + (b - a) / Real(2) : b - g_b * ((b - a) / (g_b - g_a));
    if (!(c >= a + width / Real(2))) c = a + width / Real(2);
    if (!(c <= b - width / Real(2))) c = b - width / Real(2);
    if (!(c > a) || !(c < b)) break;  // no number lies between
    const Real g_c = g(c);
    if (g_c != Real(0) && (g_c > Real(0)) == positive) {
      a = c;
      g_a = g_c;
      if (last < 0) g_b /= Real(2);
      last = -1;
    } else {
      b = c;
      g_b = g_c;
      if (last > 0) g_a /= Real(2);
      last = 1;
    }
    ++slow;
    if (b - a <= halved / Real(2)) {
      halved = b - a;
      slow = 0;
    }
  }
  return b;
}

}  // namespace apsis
