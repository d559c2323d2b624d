#pragma once

#include <apsis/body/triangle_surface.hpp>
#include <apsis/velocity/position.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace apsis {

/// Triangles that share vertices; side k of a triangle leads from its corner k to the next one.
struct triangle_mesh {
  std::vector<position> vertices;                      ///< distinct corners
  std::vector<std::array<std::size_t, 3>> corners;     ///< vertices of each triangle
  std::vector<std::array<std::size_t, 3>> neighbours;  ///< triangles beyond the sides of each triangle

  /// Returns corner k (modulo 3) of triangle t.
  const position& corner(std::size_t t, std::size_t k) const { return vertices[corners[t][k % 3]]; }
  /// Returns the cross product of two sides: the normal times twice the area.
  position area_vector(std::size_t t) const;
};

/// Returns the mesh of a closed surface without degenerate triangles (see triangle_surface). Throws
/// input_error as the constructor of triangle_surface does, except for errors of shells.
triangle_mesh make_closed_mesh(const std::vector<space_triangle>& triangles);

/// Finds the neighbours of all triangles. Throws input_error unless each edge has two triangles with
/// opposite directions.
void pair_sides(triangle_mesh& mesh);

/// Returns the triangles of each connected part.
std::vector<std::vector<std::size_t>> compute_shells(const triangle_mesh& mesh);

/// Returns the signed volume of a shell: ∫ x·n/3 over its triangles.
double compute_volume(const triangle_mesh& mesh, const std::vector<std::size_t>& shell);

/// Reverses all triangles if the total volume is negative. Throws input_error for a shell without volume, or
/// for a shell whose orientation contradicts its place inside or outside of others.
void orient_shells(triangle_mesh& mesh, const std::vector<std::vector<std::size_t>>& shells);

}  // namespace apsis
