#pragma once

#include <apsis/velocity/position.hpp>

#include <array>
#include <memory>
#include <vector>

namespace apsis {

/// Corners of a triangle in space, counterclockwise seen from the gas.
using space_triangle = std::array<position, 3>;

/// A closed surface of triangles, which may have several disjoint shells. A shell inside another one bounds a
/// cavity. Shells must neither intersect themselves nor touch each other. This is not checked; signs are
/// undefined near such points.
class triangle_surface {
 public:
  /// Merges equal corners and drops triangles with fewer than three distinct ones. Flips the edges of
  /// triangles with collinear corners. Reverses all triangles if the signed volume is negative. Throws
  /// input_error for a surface without triangles, with open or branching edges, or with neighbours of
  /// contrary orientation. Also throws it for a shell without volume, or for a shell whose orientation does
  /// not fit the shells around it.
  explicit triangle_surface(const std::vector<space_triangle>& triangles);
  ~triangle_surface();
  triangle_surface(triangle_surface&&) noexcept;             ///< the source can then only be destroyed
  triangle_surface& operator=(triangle_surface&&) noexcept;  ///< the source can then only be destroyed
  triangle_surface(const triangle_surface&) = delete;
  triangle_surface& operator=(const triangle_surface&) = delete;

  /// Returns the distance of x from the nearest triangle, negative inside. The sign is that of (x − c)·n for
  /// the nearest point c and its angle-weighted pseudonormal n (Baerentzen, Aanaes, IEEE Trans. Vis. Comput.
  /// Graph. 11, 2005). Fastest near the surface. May be called concurrently.
  double signed_distance(const position& x) const;

  double volume() const;  ///< enclosed volume, positive (dimensionless)
  double area() const;    ///< area of all triangles (dimensionless)
  int triangles() const;  ///< number of triangles that remain
  int vertices() const;   ///< number of distinct corners
  int shells() const;     ///< number of connected parts

 private:
  struct parts;
  std::unique_ptr<const parts> parts_;
};

}  // namespace apsis
