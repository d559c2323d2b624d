#pragma once

#include <apsis/run/setup.hpp>
#include <apsis/run/surface_table.hpp>

#include <vector>

namespace apsis {

/// The amounts of the invariants that the gas received in the last step, and its state after it.
struct surface_values {
  double t = 0.0,                ///< time at its end
      dt = 0.0;                  ///< its length
  std::vector<double> received;  ///< a boundary_budget; empty before the first step
  std::vector<double> observed;  ///< face_fluxes::observed() after the step; empty if it is unknown
};

/// Returns the tables of the surfaces of output.surfaces, a row for each cell face, with the columns
///   s          in the plane: arc length; on a face of the domain from its lower end, around a box
///              counter-clockwise from its lower left corner, around a body from its rightmost side, with
///              the body on the left
///   x, y, z    centre of the cell face
///   n_x, n_y, n_z or n   unit normal into the gas
///   area       of the cell face: 1 on a line, a length in the plane
///   INVARIANT  flux from the gas to the surface per unit of time and area, in the mean over the step: minus
///              the flux to the gas
/// and, where the model has the momenta m and the energy, with the normal n into the surface,
///   pressure       m·n
///   shear_stress   the component of m along the surface and an axis, counter-clockwise around a body, or
///   with
///                  three velocity dimensions the norm of the part of m along the surface; none with one
///   heat_flux      energy − u_w·m with the velocity u_w of the wall in the middle of the step
///   C_p, C_f, C_h  with output.reference: (pressure − ρT)/(ρU²/2), shear_stress/(ρU²/2), heat_flux/(ρU³/2)
/// NaN before the first step; and, of a gas, the moments of the distribution at the face, of the molecules
/// that arrive as of those that leave, after the step:
///   rho, u_x … or u, T   density, bulk velocity and temperature, NaN where they are unknown
/// and of every model with these invariants
///   mass_arriving, mass_leaving, energy_arriving, energy_leaving   face_fluxes::observed(), both ≥ 0
/// and of a wall with a given temperature, or with one from its heat balance,
///   T_w        this temperature; NaN where nothing arrives or all is reflected.
/// In the plane and in space the table also has the corners of each row.
/// Rows of a box or body in the plane are in the order of s, others in that of the ends.
std::vector<surface_table> compute_surfaces(const run_setup& setup, const surface_values& last);

}  // namespace apsis
