#pragma once

#include <apsis/output/field_series.hpp>
#include <apsis/output/table.hpp>

#include <string>
#include <vector>

namespace apsis {

/// A line along which the fields are written, a table [[output.probe]].
struct line_probe {
  std::string name;          ///< name of its file probes/NAME.csv
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
  std::string name;   ///< name of its files slices/NAME.h5 and slices/NAME.xdmf
  int direction = 0;  ///< direction of the normal
  double at = 0.0;    ///< coordinate along the normal
};

/// Returns the fields along a line, with a row for each point. The columns are s (distance from the first
/// point), the coordinates and the fields, preceded by t if there are several snapshots. The line is in
/// the units of the axes.
///
/// The fields are interpolated linearly in each direction between the centres of the cells. In the outer half
/// of the cells at ends that are not periodic, they are extrapolated linearly. Next to a cell with NaN
/// (inside a solid), the value of the nearer cell applies.
numeric_table to_table(const field_series& fields, const line_probe& line);

/// Returns the fields on a plane, interpolated in the same way: a mesh with a single point along the normal.
/// The plane is in the units of the axes.
field_series slice_of(const field_series& fields, const plane_slice& plane);

}  // namespace apsis
