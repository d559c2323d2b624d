#pragma once

#include <apsis/mesh/grid.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace apsis {

/// One direction of a mesh in results. Fields are stored in the order of the cells, the last axis fastest.
struct mesh_axis {
  std::string name;             ///< "x", "y" or "z"
  std::vector<double> centres;  ///< coordinates of the cell centres, equidistant and increasing
  bool periodic = false;        ///< whether the last cell is followed by the first one
};

/// Returns the axes of a mesh, not periodic.
std::vector<mesh_axis> mesh_axes(const grid& mesh);

/// Returns the number of cells along each axis; {1} without axes, for a model without space.
std::vector<std::uint64_t> mesh_shape(const std::vector<mesh_axis>& axes);

/// Returns the number of cells; 1 without axes.
std::size_t mesh_size(const std::vector<mesh_axis>& axes);

/// Returns the coordinate of a cell along axis k.
double centre_of_cell(const std::vector<mesh_axis>& axes, std::size_t cell, std::size_t k);

}  // namespace apsis
