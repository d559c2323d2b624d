#pragma once

#include <apsis/velocity/velocity_set.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace apsis {

/// One axis of a velocity set that is a tensor product. Dimensionless.
struct velocity_axis {
  std::string name;             ///< "v" for a single axis, otherwise "v_x", "v_y" or "v_z"
  std::vector<double> nodes;    ///< strictly increasing or strictly decreasing
  std::vector<double> weights;  ///< quadrature weights of the nodes; with several axes their sum is the width
};

/// Returns the axes of a velocity set, slowest first. Empty if the set is not a tensor product in this
/// order. In such a product v_j = (nodes_x[i_x], nodes_y[i_y], …) with j = (i_x n_y + i_y) n_z + i_z, and
/// weights are products.
std::vector<velocity_axis> velocity_axes(const velocity_set& velocities);

/// Returns the coordinates [point][dimension] of the velocities of a set, [point] in one dimension.
std::vector<double> velocity_points(const velocity_set& velocities);

/// The integral of f over all velocity components but one.
struct marginal_distribution {
  velocity_axis axis;          ///< axis of the remaining component
  std::string label;           ///< "f integrated over v_y"
  std::vector<double> values;  ///< [cell][node]
};

/// Returns for each axis k the marginal F_k(x, v_k) = ∫ f dv_l over all l ≠ k. The sum of F_k with the
/// weights of the axis is the density. f is [cells][velocities.components()]. Empty for fewer than two
/// velocity dimensions, sets that are not a tensor product, and several sets of components.
std::vector<marginal_distribution> marginals(const std::vector<double>& f, std::uint64_t cells,
                                             const velocity_set& velocities);

}  // namespace apsis
