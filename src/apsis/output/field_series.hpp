#pragma once

#include <apsis/model/dimension.hpp>
#include <apsis/output/mesh_axis.hpp>
#include <apsis/output/table.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Macroscopic fields on one mesh at one or several times. Dimensionless unless `units` are given.
struct field_series {
  /// The fields at one time.
  struct snapshot {
    double t = 0.0;                           ///< time
    std::vector<std::vector<double>> values;  ///< [field][cell]
  };
  std::vector<mesh_axis> axes;              ///< x, y, z; empty for a model without space (one cell)
  std::vector<std::string> names,           ///< field names: "rho"
      labels,                               ///< for plots: "density (dimensionless)"
      units = {};                           ///< units of the fields; empty if they are dimensionless
  std::string unit_of_x = "dimensionless",  ///< unit of coordinates
      unit_of_t = "dimensionless";          ///< unit of times
  std::vector<dimension> dimensions = {};   ///< physical dimensions of the fields
  std::vector<snapshot> snapshots;          ///< in order of time
};

/// Returns one row per cell with columns x, y, z and the fields, preceded by t if there are several
/// snapshots.
numeric_table to_table(const field_series& fields);

}  // namespace apsis
