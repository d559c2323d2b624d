#pragma once

#include <apsis/velocity/position.hpp>

#include <cmath>

/// Arithmetic of vectors in space.
namespace apsis::vectors {

/// Returns a − b.
inline position difference(const position& a, const position& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Returns a + t b.
inline position add_multiple(const position& a, double t, const position& b) {
  return {a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]};
}

/// Returns a·b.
inline double dot(const position& a, const position& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Returns a × b.
inline position cross(const position& a, const position& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Returns |a|, without overflow of squares.
inline double length(const position& a) {
  return std::hypot(a[0], a[1], a[2]);
}

}  // namespace apsis::vectors
