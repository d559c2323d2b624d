#pragma once

#include <apsis/model/dimension.hpp>
#include <apsis/output/polydata.hpp>
#include <apsis/output/table.hpp>
#include <apsis/velocity/position.hpp>

#include <string>
#include <vector>

namespace apsis {

/// The fluxes of the last step out of the gas at the cell faces of a surface: a face of the domain that is
/// not periodic, or a solid box.
struct surface_table {
  std::string name;                        ///< of the face or of the box
  std::vector<std::string> faces;          ///< [row], of the domain or of the box
  numeric_table numbers;                   ///< [row], see compute_surfaces()
  std::vector<dimension> dimensions = {};  ///< of the columns, in units of a gas
  /// [row], in the order of wall_segment::corners; none on a line.
  std::vector<std::vector<position>> corners = {};
};

/// Returns the pieces of the surface as cells, with every column as numbers of these, and with the vectors
///   normal    into the gas
///   momentum, u, and tau, the part of momentum along the surface, as far as the columns are there.
polydata to_polydata(const surface_table& surface);

/// Returns the table as text, with the face in the first column; see to_csv() of numbers.
std::string to_csv(const surface_table& surface);

}  // namespace apsis
