#pragma once

#include <apsis/study/outcome.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Norms of a difference d over cells and components. V is the volume of the gas in a cell, times that of a
/// velocity cell for kinetic models; it is 1 without space. The cells of axisymmetric flow are rings.
/// Dimensionless.
enum class error_norm {
  l1,   ///< Σ |d| V
  l2,   ///< (Σ d² V)^½
  linf  ///< max |d|
};

/// Returns the norm of a name: "l1", "l2" or "linf". Throws input_error with the nearest name for any other.
error_norm find_norm(const std::string& name);
/// Returns the name that find_norm() accepts.
std::string to_string(error_norm norm);

/// Checks whether results of the two cases can be subtracted. They must have the same model, end time,
/// domain, solid boxes and unknowns of a cell. Without a `quantity`, which compares the full state, they must
/// also have the same velocities. The mesh of `reference` must be such that its results can be brought onto
/// that of `run`. Past bodies both meshes must be the same. Throws input_error with the key or direction that
/// differs.
void check_comparable(const case_config& run, const case_config& reference, const std::string& quantity);

/// Returns the state of `finer` on the mesh of `run`, [cells][components]. Throws input_error if
/// the meshes do not fit. Every direction has its own ratio of cells.
/// - Finite volumes: cell averages of cell averages, exact. The numbers of cells must be multiples.
/// - Finite differences: point values at the centres of the coarse cells. Unless the ratio is odd, these lie
///   between the centres of the fine mesh. There the values are those of the polynomial through the eight
///   nearest points along each direction (fewer on smaller meshes and between solid boxes). Its eighth order
///   preserves the fifth order of the scheme.
std::vector<double> on_mesh_of(const outcome& run, const outcome& finer);

/// Returns the norm of the difference of a run and a state on its mesh. If `quantity` names a
/// macroscopic field, the difference is that of this field, computed on the mesh of the run.
/// Dimensionless. NaN if a value is NaN.
double difference_norm(const outcome& run, const std::vector<double>& state, error_norm norm,
                       const std::string& quantity = "");

/// Returns the same norm between two runs: difference_norm(run, on_mesh_of(run, finer), …). Macroscopic
/// fields may be compared across velocity grids.
double difference_norm(const outcome& run, const outcome& finer, error_norm norm,
                       const std::string& quantity = "");

}  // namespace apsis
