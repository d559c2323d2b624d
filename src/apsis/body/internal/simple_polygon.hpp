#pragma once

#include <apsis/body/shape_value.hpp>
#include <apsis/velocity/position.hpp>

#include <vector>

namespace apsis {

/// Returns twice the signed area of the triangle (a, b, c) in the plane: positive if c is left of a → b.
inline double turn_of(const position& a, const position& b, const position& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
}

/// Throws input_error unless a closed polygon is simple: no edge has the length 0, and no two edges touch
/// except at their common end. The message names two points or two edges.
void check_simple_polygon(const std::vector<position>& corners, const shape_arguments& from);

}  // namespace apsis
