#pragma once

#include <apsis/model/dimension.hpp>
#include <apsis/output/polydata.hpp>
#include <apsis/output/table.hpp>
#include <apsis/velocity/position.hpp>

#include <string>
#include <vector>

namespace apsis {

/// The fluxes of the last step from the gas to the cell faces of a surface. A surface is a face of the domain
/// that is not periodic, a solid box or a body.
struct surface_table {
  std::string name;                ///< name of the surface
  std::vector<std::string> faces;  ///< [row], face of the domain or of the box; "wall" for a wall segment
  numeric_table numbers;           ///< [row], see compute_surfaces()
  std::vector<dimension> dimensions = {};  ///< physical dimensions of the columns
  /// [row], corners in the order of wall_segment::corners; empty on a line.
  std::vector<std::vector<position>> corners = {};
};

/// Returns the pieces of the surface as cells, with every column as their numbers. Adds the vector normal,
/// into the gas. If the surface has their columns, also adds the vectors momentum, u, and tau, the part of
/// momentum along the surface.
polydata to_polydata(const surface_table& surface);

/// Returns the table as text, with the face in the first column; see to_csv() of numbers.
std::string to_csv(const surface_table& surface);

}  // namespace apsis
