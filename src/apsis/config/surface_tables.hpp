#pragma once

#include <apsis/config/initial_table.hpp>

#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// Stands for every surface in output.surfaces.
inline constexpr const char* all_surfaces = "all";

/// A table [boundary.left], [boundary.right], …: the boundary condition of a face.
struct face_table {
  std::optional<std::string> kind;  ///< space.boundary where it is not set
  state_formulas values;            ///< of the variables of the kind, formulas in t and the position
  bool operator==(const face_table&) const = default;  ///< equal texts
};

/// A table [[space.solid]]: a solid box and its wall.
struct solid_table {
  std::string name;              ///< in the history of what its walls receive
  std::vector<double> from;      ///< lower corner, on edges of cells
  std::vector<double> to;        ///< upper corner, on edges of cells
  std::string kind = "diffuse";  ///< boundary condition at its faces
  state_formulas values;         ///< of the variables of the kind, formulas in t and the position
  bool operator==(const solid_table&) const = default;  ///< equal texts
};

}  // namespace apsis
