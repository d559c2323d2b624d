#pragma once

#include <apsis/study/outcome.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Norms of a difference d over cells and components, with V the volume of a cell (length of a cell, times
/// that of a velocity cell for kinetic models; 1 without space). Dimensionless.
enum class error_norm {
  l1,   ///< Σ |d| V
  l2,   ///< (Σ d² V)^½
  linf  ///< max |d|
};

/// Throws input_error with the nearest name; names are "l1", "l2" and "linf".
error_norm find_norm(const std::string& name);
/// Returns the name that find_norm() accepts.
std::string to_string(error_norm norm);

/// Whether results of the two cases can be subtracted: same model, end time, domain, unknowns of a cell and
/// velocities (the last only where the full state is compared, `quantity` ""), and a mesh of `reference` that
/// can be brought onto that of `run`. Throws input_error, with the key that differs.
void check_comparable(const case_config& run, const case_config& reference, const std::string& quantity);

/// Returns the state of `finer` on the mesh of `run`, [cells][components]. Finite volumes: cell averages of
/// cell averages, exact; the numbers of cells must be multiples. Finite differences: point values at the
/// centres of the coarse cells, which lie between those of the fine mesh unless the ratio is odd, by the
/// polynomial through the eight nearest points (eighth order, to preserve the fifth order of the scheme;
/// fewer points on smaller meshes). Throws input_error.
std::vector<double> on_mesh_of(const outcome& run, const outcome& finer);

/// Norm of the difference of a run and a state on its mesh, or of a macroscopic field if `quantity` names one
/// (computed from the state on the mesh of the run). Dimensionless. NaN if a value is NaN.
double difference_norm(const outcome& run, const std::vector<double>& state, error_norm norm,
                       const std::string& quantity = "");

/// The same norm between two runs: difference_norm(run, on_mesh_of(run, finer), …); macroscopic fields may be
/// compared across velocity grids.
double difference_norm(const outcome& run, const outcome& finer, error_norm norm,
                       const std::string& quantity = "");

}  // namespace apsis
