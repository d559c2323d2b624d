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

/// A solid box or body whose loads a run records: it has a momentum for each of two or three directions of
/// space.
struct loaded_body {
  std::string name;  ///< run_setup::open_faces()
  std::size_t face;  ///< its place among these
};

/// Returns the solid boxes and bodies with loads, in the order of run_setup::open_faces().
std::vector<loaded_body> loaded_bodies(const run_setup& setup);

/// Force, torque and heat that the gas gives to a solid box or body per unit of time, in the mean over a
/// step; in the plane per length. Dimensionless.
struct body_load {
  std::string name;            ///< of the box or body
  std::vector<double> force;   ///< [direction]
  std::vector<double> torque;  ///< about the origin: the component along z in the plane, in space all three
  double heat = 0.0;           ///< energy, with the work on a wall that moves
};

/// Returns the loads of all loaded_bodies() in a step.
std::vector<body_load> body_loads(const run_setup& setup, const step_record& step);

/// A number that belongs to a body.
struct load_value {
  std::string name;        ///< "C_D"
  double value = 0.0;      ///< dimensionless
  dimension dims = {};     ///< in units of a gas
  bool is_torque = false;  ///< whose unit is not that of an energy
};

/// Returns the loads of a body in the directions of a stream with ρ, U, the length L and in space the area S
/// (in the plane S = L and loads are per length), and their coefficients:
///     drag = F·U/|U|,                  C_D = drag/(ρU²S/2),
///     lift = F·l, lift_direction(),    C_L = lift/(ρU²S/2),
///     moment = torque − centre × F,    C_M = moment/(ρU²SL/2), with _x, _y, _z in space,
///     heat,                            C_H = heat/(ρ|U|³S/2).
/// Lift is missing where it has no direction.
std::vector<load_value> loads_in_stream(const body_load& body, const reference_values& stream);

/// Returns the columns of the torques in the history: torque_NAME of every loaded body in the plane,
/// torque_NAME_x and so on in space.
std::vector<std::string> torque_columns(const run_setup& setup);

/// Returns the units of the columns that with_loads() adds, and of the torques.
std::vector<history_unit> load_units(const simulation& run);

/// Returns a history with the columns drag_NAME, lift_NAME, moment_NAME, heat_NAME, C_D_NAME, C_L_NAME,
/// C_M_NAME and C_H_NAME of every loaded body, of loads_in_stream(); the history itself without
/// output.reference.
numeric_table with_loads(numeric_table history, const simulation& run);

}  // namespace apsis
