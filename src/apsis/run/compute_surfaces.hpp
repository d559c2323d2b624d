#pragma once

#include <apsis/run/setup.hpp>
#include <apsis/run/surface_table.hpp>

#include <vector>

namespace apsis {

/// Amounts of the invariants that the gas received in the last step, and moments at its
/// boundary after the step.
struct surface_values {
  double t = 0.0,                ///< time at the end of the step
      dt = 0.0;                  ///< length of the step
  std::vector<double> received;  ///< a boundary_budget; empty before the first step
  std::vector<double> observed;  ///< face_fluxes::observed() after the step; empty if it is unknown
};

/// Returns the tables of the surfaces of output.surfaces, with a row for each cell face. In the plane and in
/// space the table also has the corners of each row. In the plane the rows of a box or body are in the order
/// of s; other rows are in the order of the segments.
///
/// Columns of every table:
/// - s: arc length, in the plane only. It begins at the lower end of a face of the domain, or at the lower
///   left corner of a box; on a body it begins at the rightmost side. Around a box it increases
///   counter-clockwise, around a body with the body on the left.
/// - x, y, z: centre of the cell face
/// - n_x, n_y, n_z or n: unit normal into the gas
/// - area: of the cell face; 1 on a line, a length in the plane
/// - INVARIANT: flux from the gas to the surface per unit of time and area, averaged over the step; NaN
///   before the first step. It is minus the flux to the gas.
///
/// Columns if the model has the momenta m and the energy; n is the normal into the surface, u_w the velocity
/// of the wall in the middle of the step:
/// - pressure: m·n
/// - shear_stress: with two velocity dimensions the component of m along the surface and an axis,
///   counter-clockwise around a body. With three velocity dimensions it is the norm of the part of m along
///   the surface. With one there is no such column.
/// - heat_flux: energy − u_w·m
/// - C_p, C_f, C_h: with output.reference, (pressure − ρT)/(ρU²/2), shear_stress/(ρU²/2), heat_flux/(ρU³/2)
///
/// Columns of the state at the face after the step:
/// - rho, u_x … or u, T: of a gas, density, bulk velocity and temperature of all molecules at the face,
///   arriving and leaving; NaN where unknown
/// - mass_arriving, mass_leaving, energy_arriving, energy_leaving: face_fluxes::observed(), all ≥ 0; of every
///   model with these invariants
/// - T_w: temperature of a wall that is given or follows from its heat balance; NaN where nothing arrives
///   or all is reflected
std::vector<surface_table> compute_surfaces(const run_setup& setup, const surface_values& last);

}  // namespace apsis
