#pragma once

#include <string>
#include <vector>

#include <validation/quantity.hpp>

namespace apsis::validation {

/// A convex body in a stream of free molecules along x: a case with the parameters M, Kn and alpha, and a
/// body of the same name.
struct body_in_free_stream {
  std::string case_name;                ///< "gas/sphere"
  std::string body;                     ///< "sphere"
  double area = 1.0;                    ///< across the stream, of the part of the body in the domain
  std::vector<std::string> resolution;  ///< overrides of the case: mesh, velocities, final time
};

/// Returns the parameters mach, quantity and accommodation of a coefficient of a body.
std::vector<quantity_parameter> free_stream_parameters();

/// Returns the bulk velocity of the stream, mach sqrt(5/3) for the density and temperature 1. Throws
/// input_error for a Mach number outside 0.5 to 8.
double speed_of_stream(const quantity_values& parameters);

/// Returns the drag coefficient, force/(ρU²/2 area), or the heat coefficient, heat/(ρU³/2 area). Throws
/// input_error for parameters out of range.
double free_stream_coefficient(const body_in_free_stream& of, const quantity_values& parameters,
                               const quantity_run& make);

}  // namespace apsis::validation
