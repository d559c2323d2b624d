#pragma once

#include <apsis/model/plane_walk.hpp>

namespace apsis {

/// Gaussians on planes of velocities, for the instruction set of this processor.
namespace plane_rows {

/// m ← the values of a walk at n velocities v of every row, one row after the other.
void fill(const plane_walk& of, const double* v, int n, double* m);

/// Three tables with one row for each velocity of the first direction of their plane.
struct tables {
  int n[3];             ///< number of velocities of each direction
  const double *of_01,  ///< table of the directions 0 and 1
      *of_02,           ///< table of the directions 0 and 2
      *of_12;           ///< table of the directions 1 and 2
};

/// m_ijk ← product of the entries ij, ik and jk of the tables.
void multiply(const tables& of, double* m);

}  // namespace plane_rows
}  // namespace apsis
