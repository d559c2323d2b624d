#pragma once

#include <apsis/output/table.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Macroscopic fields on one mesh at one or several times. `x` is empty where the model has no space (one
/// cell). Dimensionless.
struct field_series {
  struct snapshot {
    double t = 0.0;
    std::vector<std::vector<double>> values;  ///< [field][cell]
  };
  std::vector<double> x;                   ///< cell centres
  std::vector<std::string> names, labels;  ///< of the fields
  std::vector<snapshot> snapshots;
};

/// One row per cell: (t,) x, fields; the column t only where there are several snapshots.
table to_table(const field_series& fields);

}  // namespace apsis
