#pragma once

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/oblique_wall.hpp>
#include <apsis/mesh/face.hpp>

#include <array>
#include <vector>

namespace apsis {

// Functions of this header throw as refuse_value() does.

/// Returns the fraction of molecules that a wall re-emits. Throws input_error if it is not from 0 to 1.
double accommodation_at(const face_quantity& accommodation, double t, const position& at);

/// Returns the velocity of the wall at a face of the domain. Throws input_error if it is not 0 along the
/// normal.
std::array<double, 3> velocity_along(const std::vector<face_quantity>& velocity, const face& where, double t,
                                     const position& at);

/// Returns the part of the velocity along a wall with any normal. Throws input_error if the component along
/// the normal exceeds half of the speed.
std::array<double, 3> velocity_along(const std::vector<face_quantity>& velocity, const wall_point& where);

}  // namespace apsis
