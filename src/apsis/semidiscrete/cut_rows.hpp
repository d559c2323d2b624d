#pragma once

#include <array>
#include <span>

namespace apsis {

/// Loops over the rows of cut cells, for the instruction set of this processor. `outward` is the share of the
/// gas of a cell that leaves through a face or wall per unit of time, of every component: < 0 where it
/// enters.
namespace cut_rows {

/// The gradient of a row: one row for each direction.
using gradient = std::array<double*, 3>;

/// outward ← rate Σ_k vector[k] speeds[k]. The sign of the sum does not depend on the rate.
void project(const std::array<double, 3>& vector, double rate, const std::array<const double*, 3>& speeds,
             int directions, int n, double* outward);

/// A neighbour in a least-squares gradient.
struct neighbour {
  const double* row;             ///< its values
  std::array<double, 3> weight;  ///< of the difference to it, for each direction
};

/// slopes[d] ← Σ weight[d] (row − u) over the neighbours.
void fit(const double* u, std::span<const neighbour> around, int directions, int n, const gradient& slopes);

/// Sums over the faces and walls of a cell for its limiter, a row each.
struct demand_rows {
  double *size,   ///< largest sum of the sizes of terms of a correction
      *outflow,   ///< of a step, as a share of the gas
      *increase;  ///< of the outflow by corrections
};

/// Adds a face or wall at a vector from the centroid, for a step of length `step`.
void add_demand(const double* outward, double step, const gradient& slopes,
                const std::array<double, 3>& vector, int directions, int n, const demand_rows& demand);

/// Multiplies the slopes by the factor of the limiter. `kept`: the shares of u that transport may take,
/// a row.
void limit(const double* u, const demand_rows& demand, const double* kept, int directions, int n,
           const gradient& slopes);

/// values ← u + slopes·vector where outward > 0, and 0 for negligible u; elsewhere they stay as they are.
/// `limited`: no value is negative where u is not.
void leave(const double* u, const double* outward, const gradient& slopes,
           const std::array<double, 3>& vector, bool limited, int directions, int n, double* values);

/// rate ← rate − outward values.
void take(const double* outward, const double* values, int n, double* rate);

/// acc ← (fresh ? 0 : acc) + α u + β rate.
void add(const double* u, const double* rate, double alpha, double beta, bool fresh, int n, double* acc);

}  // namespace cut_rows
}  // namespace apsis
