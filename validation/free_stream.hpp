#pragma once

#include <string>
#include <vector>

#include <validation/quantity.hpp>

namespace apsis::validation {

/// Returns the parameters mach, quantity and accommodation of a coefficient of a body.
std::vector<quantity_parameter> free_stream_parameters();

/// Returns the bulk velocity of the stream, mach sqrt(5/3) for density and temperature 1 (dimensionless).
/// Throws input_error for a Mach number outside 0.5 to 8.
double speed_of_stream(const quantity_values& parameters);

/// Returns a load of the first body of a run, such as "C_D", relative to output.reference. Throws input_error
/// for an unknown name.
double load_in_stream(const simulation& run, const std::string& wanted);

/// Returns the drag or heat coefficient of a convex body in a stream of free molecules along x. The case has
/// the parameters M, Kn and alpha, one body, and output.reference; `resolution` overrides its mesh,
/// velocities and final time. Throws input_error for parameters out of range.
double free_stream_coefficient(const std::string& case_name, const std::vector<std::string>& resolution,
                               const quantity_values& parameters, const quantity_run& make);

}  // namespace apsis::validation
