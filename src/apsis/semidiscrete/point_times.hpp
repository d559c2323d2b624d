#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/model/model.hpp>

#include <span>

namespace apsis {

/// A time scale of a collision at one point, of a row and ε.
using point_time = double (point_collision::*)(const double* row, double epsilon);

/// Returns the smallest value of a time scale over cells and their points, with the row of the cell at each:
/// epsilon[cell · points_per_cell + q]. `cells`: those that count, all if there are none.
double smallest_time(const model& equation, const field& u, std::span<const double> epsilon,
                     int points_per_cell, bool keeps_sign, point_time time,
                     std::span<const cell_range> cells = {});

}  // namespace apsis
