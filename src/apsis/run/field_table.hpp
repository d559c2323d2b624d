#pragma once

#include <apsis/model/dimension.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Macroscopic fields on the mesh at one time: values[field][cell], the last direction of space fastest.
struct field_table {
  std::vector<double> x;                    ///< of the centre of every cell; {0} without space
  std::vector<std::string> names,           ///< field names: "rho"
      labels;                               ///< for plots: "density (dimensionless)"
  std::vector<std::vector<double>> values;  ///< [field][cell]
  std::vector<dimension> dimensions = {};   ///< dimensions in units of a gas
  std::vector<double> y = {},               ///< of the centre of every cell; empty in one dimension
      z = {};                               ///< of the centre of every cell; empty in fewer than three
  std::vector<int> shape = {};              ///< number of cells along x, y, z; {1} without space
};

}  // namespace apsis
