#pragma once

#include <apsis/model/dimension.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Macroscopic fields on the mesh at one time. The last direction of space varies fastest.
struct field_table {
  std::vector<double> x;                    ///< x of every cell centre; {0} without space
  std::vector<std::string> names,           ///< field names: "rho"
      labels;                               ///< for plots: "density (dimensionless)"
  std::vector<std::vector<double>> values;  ///< [field][cell]
  std::vector<dimension> dimensions = {};   ///< physical dimensions of the fields
  std::vector<double> y = {},               ///< y of every cell centre; empty in one dimension
      z = {};                               ///< z of every cell centre; empty in fewer than three dimensions
  std::vector<int> shape = {};              ///< number of cells along x, y, z; {1} without space
};

}  // namespace apsis
