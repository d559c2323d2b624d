#pragma once

#include <apsis/mesh/grid.hpp>

#include <span>
#include <string>
#include <vector>

namespace apsis {

/// A line along which the fields are written, a table [[output.probe]].
struct line_probe {
  std::string name;          ///< of its file probes/NAME.csv
  std::vector<double> from,  ///< first point
      to;                    ///< last point
  int points = 101;          ///< equidistant points, both ends included

  /// Multiplies the coordinates by a unit of length.
  void scale(double unit) {
    for (auto* end : {&from, &to})
      for (double& x : *end) x *= unit;
  }
};

/// A plane on which the fields are written, a table [[output.slice]].
struct plane_slice {
  std::string name;   ///< of its files slices/NAME.h5 and slices/NAME.xdmf
  int direction = 0;  ///< of the normal
  double at = 0.0;    ///< coordinate along the normal
};

/// Stands for every surface in output.surfaces.
inline constexpr const char* all_surfaces = "all";

/// Returns the cell that contains a point of the domain; of two, the upper one.
int cell_at(const grid& mesh, std::span<const double> x);

}  // namespace apsis
