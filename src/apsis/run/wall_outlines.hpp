#pragma once

#include <apsis/output/solution.hpp>
#include <apsis/run/setup.hpp>

#include <vector>

namespace apsis {

/// Returns the corners of the face of a cell at an end of a segment, in the order of wall_segment::corners;
/// empty on a line. Neighbouring faces have bitwise equal corners.
std::vector<position> corners_of_end(const domain& space, int surface, int place);

/// Returns the walls of the bodies of the whole mesh, with lengths multiplied by a unit.
std::vector<wall_outline> wall_outlines(const run_setup& setup, double unit_of_length);

}  // namespace apsis
