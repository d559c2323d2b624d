#pragma once

#include <array>
#include <span>

namespace apsis {

/// Loops over the rows of cut cells, for the instruction set of this processor. `outward` is, for every
/// component, the part of the gas of a cell that leaves through a face or wall per unit of time. It is < 0
/// for components that enter. A row that is written does not overlap others.
namespace cut_rows {

/// The gradient of a row: one row for each direction.
using gradient = std::array<double*, 3>;

/// The sizes of all rows.
struct extent {
  int directions;  ///< of space
  int components;  ///< of the model
};

/// A face or wall of a cell.
struct way_out {
  std::array<double, 3> normal;         ///< unit vector out of the gas for rate > 0
  double rate;                          ///< area / volume
  std::array<const double*, 3> speeds;  ///< speeds of every component along each direction
};

/// A linear function in a cell.
struct line {
  const double* value;           ///< value at the centroid of its gas
  gradient slopes;               ///< its slopes along each direction
  std::array<double, 3> vector;  ///< vector from the centroid to a point
  bool limited;                  ///< whether leaving values are nonnegative if that of the cell is
};

/// outward ← rate Σ_k normal[k] speeds[k]. The sign of the sum does not depend on the rate.
void project(const way_out& way, const extent& of, double* outward);

/// A neighbour in a least-squares gradient.
struct neighbour {
  const double* row;             ///< values of the neighbour
  std::array<double, 3> weight;  ///< weight of the difference to it, for each direction
};

/// slopes[d] ← Σ weight[d] (row − u) over the neighbours.
void fit(const double* u, std::span<const neighbour> around, const extent& of, const gradient& slopes);

/// A face or wall of a cell, with the vector to its middle from the centroid of the gas.
struct outlet {
  way_out way;                   ///< the face or wall
  std::array<double, 3> vector;  ///< vector to its middle
};

/// Bounds of a linear function at the outlets of a cell.
struct line_bounds {
  std::span<const outlet> outlets;  ///< all faces and walls
  double step;                      ///< length of a step
  /// Fraction of u that transport may take in a step, of every component. For a steady state `more` of
  /// cut_demand::steady_factor().
  const double* kept;
  bool steady;  ///< whether to limit for a steady state
};

/// Fits with a limiter: slopes[d] ← ϑ Σ weight[d] (row − u).
void fit(const double* u, std::span<const neighbour> around, const line_bounds& within, const extent& of,
         const gradient& slopes);

/// Sets values to the linear function for components with `outward` > 0, with 0 for negligible values. Leaves
/// other values unchanged.
void leave(const double* outward, const line& here, const extent& of, double* values);

/// Sets values to the linear function for components that leave through the face, and to 0 for others.
void leave_alone(const way_out& way, const line& here, const extent& of, double* values);

/// A face to another cell.
struct crossing {
  way_out way;                   ///< the face
  std::array<double, 3> vector;  ///< vector to its middle from the centroid of the gas
  line beyond;                   ///< that of the other cell; without slopes, its value at the face
};

/// rate ← rate − Σ outward f over faces, one after the other. f is the function `here` for components that
/// leave, and the one beyond the face for others. The vector of `here` is not used.
void pass(std::span<const crossing> faces, const line& here, const extent& of, double* rate);

/// rate ← rate − outward values.
void take(const double* outward, const double* values, int n, double* rate);

/// acc ← (fresh ? 0 : acc) + α u + β rate.
void add(const double* u, const double* rate, double alpha, double beta, bool fresh, int n, double* acc);

}  // namespace cut_rows
}  // namespace apsis
