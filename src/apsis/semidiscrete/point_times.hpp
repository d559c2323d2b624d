#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/model/model.hpp>

#include <span>

namespace apsis {

/// A time scale of a collision at one point, for a row and ε.
using point_time = double (point_collision::*)(const double* row, double epsilon);

/// Returns the smallest value of a time scale over cells and their points. Each point has the row of its cell
/// and epsilon[cell · points_per_cell + q]. `cells` are the cells that count; an empty list means all.
/// Returns +infinity without cells.
double smallest_time(const model& equation, const field& u, std::span<const double> epsilon,
                     int points_per_cell, bool keeps_sign, point_time time,
                     std::span<const cell_range> cells = {});

}  // namespace apsis
