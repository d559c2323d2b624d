#pragma once

#include <apsis/model/dimension.hpp>
#include <apsis/output/table.hpp>

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
};

/// Returns the table as text, with the face in the first column; see to_csv() of numbers.
std::string to_csv(const surface_table& surface);

}  // namespace apsis
