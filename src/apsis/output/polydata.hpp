#pragma once

#include <apsis/velocity/position.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Segments of lines, or polygons, with numbers for each: polydata of VTK.
struct polydata {
  /// Numbers of every cell.
  struct array {
    std::string name;            ///< shown by ParaView
    int components = 1;          ///< numbers of each cell: 3 for a vector
    std::vector<double> values;  ///< [cell][component]
  };
  std::vector<std::vector<position>>
      cells;                ///< corners of each: two of a segment, three or more of a polygon
  std::vector<array> data;  ///< numbers of the cells
};

/// Returns the content of a file NAME.vtp, which ParaView and VTK open. Equal corners are one point, so that
/// cells are connected. Numbers have all bits: base64 of 64-bit numbers in the byte order of this machine.
std::string to_vtp(const polydata& surface);

}  // namespace apsis
