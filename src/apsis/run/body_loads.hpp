#pragma once

#include <apsis/config/reference_values.hpp>
#include <apsis/model/dimension.hpp>
#include <apsis/output/table.hpp>
#include <apsis/run/run_state.hpp>
#include <apsis/run/setup.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace apsis {

class simulation;
struct history_unit;

/// A solid box or body whose loads a run records. Such a run has two or three directions of space, an energy,
/// and a momentum for each direction.
struct loaded_body {
  std::string name;      ///< as in run_setup::open_faces()
  std::size_t face;      ///< index in run_setup::open_faces()
  std::size_t obstacle;  ///< number of grid::solid()
};

/// Returns the solid boxes and bodies with loads, in the order of run_setup::open_faces().
std::vector<loaded_body> loaded_bodies(const run_setup& setup);

/// Force, torque and heat that the gas gives to a solid box or body per unit of time, averaged over a step.
/// In the plane they are per unit length. Dimensionless.
struct body_load {
  std::string name;            ///< name of the box or body
  std::vector<double> force;   ///< [direction]
  std::vector<double> torque;  ///< about the origin: [z] in the plane, [x, y, z] in space
  double heat = 0.0;           ///< energy, including the work on a moving wall
  /// Directions normal to the planes of symmetry that the body touches: it is one part of a symmetric body.
  std::vector<int> mirrors = {};
};

/// Returns the loads of all loaded_bodies() in a step.
std::vector<body_load> body_loads(const run_setup& setup, const step_record& step);

/// A load of a body, or a coefficient.
struct load_value {
  std::string name;        ///< "C_D"
  double value = 0.0;      ///< dimensionless
  dimension dims = {};     ///< physical dimension of the load
  bool is_torque = false;  ///< whether its unit is that of a torque, not of an energy
};

/// Returns the loads of a body in the directions of a stream, and their coefficients. The stream has
/// the density ρ, the velocity U, the length L and, in space, the area S. In the plane S = L, and loads
/// are per unit length.
///     drag = F·U/|U|,                  C_D = drag/(ρU²S/2),
///     lift = F·l, lift_direction(),    C_L = lift/(ρU²S/2),
///     moment = torque − centre × F,    C_M = moment/(ρU²SL/2), with _x, _y, _z in space,
///     heat,                            C_H = heat/(ρ|U|³S/2).
/// Lift is omitted if it has no direction. Part of a symmetric body has no lift along a mirrored direction,
/// and no moment along others: those of the whole body vanish.
std::vector<load_value> loads_in_stream(const body_load& body, const reference_values& stream);

/// Returns the history columns of the torques: torque_NAME of every loaded body in the plane, torque_NAME_x
/// and so on in space.
std::vector<std::string> torque_columns(const run_setup& setup);

/// Returns the units of the torque columns, and of the columns that with_loads() adds.
std::vector<history_unit> load_units(const simulation& run);

/// Adds to a history the columns drag_NAME, lift_NAME, moment_NAME, heat_NAME, C_D_NAME, C_L_NAME,
/// C_M_NAME and C_H_NAME of every loaded body, from loads_in_stream(). Returns the history unchanged
/// without output.reference.
numeric_table with_loads(numeric_table history, const simulation& run);

}  // namespace apsis
