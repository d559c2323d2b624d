#pragma once

#include <apsis/output/table.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Macroscopic fields on one mesh at one or several times. `x` is empty where the model has no space (one
/// cell). Dimensionless.
struct field_series {
  /// The fields at one time.
  struct snapshot {
    double t = 0.0;                           ///< time
    std::vector<std::vector<double>> values;  ///< [field][cell]
  };
  std::vector<double> x;            ///< cell centres
  std::vector<std::string> names,   ///< of the fields: "rho"
      labels;                       ///< for plots: "density (dimensionless)"
  std::vector<snapshot> snapshots;  ///< from the first to the last
};

/// One row per cell: (t,) x, fields; the column t only where there are several snapshots.
numeric_table to_table(const field_series& fields);

}  // namespace apsis
