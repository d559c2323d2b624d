#pragma once

#include <apsis/model/line_powers.hpp>

namespace apsis {

/// Newton's method of model/formulas/nearby.hpp for eight cells side by side, for the instruction set of this
/// processor. Results have the bits of nearby_maxwellian() for one cell.
namespace nearby_cells {

/// Number of cells side by side.
inline constexpr int together = 8;

/// Returns how many numbers of problem::lanes a direction of n points needs.
constexpr int numbers_for(int n) {
  return (n + together - 1) / together * together * together;
}

/// One direction of a velocity grid.
struct direction {
  line_powers::points line;  ///< its points
  double u[together];        ///< bulk velocities of the cells
  double* rows[together];    ///< weights of the cells, one number for each point
};

/// Cells and their directions. A cell may be given several times.
struct problem {
  int dimensions;          ///< number of directions
  direction of[3];         ///< directions
  double T[together],      ///< temperatures
      rho[together];       ///< densities
  double weight_of_grid;   ///< weight of every point of the grid
  double* lanes;           ///< scratch memory, numbers_for(n) numbers for each direction
  double found[together],  ///< result: 1 if the weights have the moments of the state, else 0
      factor[together];    ///< result: the factor that gives the product of the weights the density ρ
};

/// Rows contain Gaussians, which become the weights with the moments of the state. In one direction the rows
/// are also multiplied by the factor.
void solve(problem& of);

}  // namespace nearby_cells
}  // namespace apsis
