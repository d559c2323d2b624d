#pragma once

#include <apsis/config/case.hpp>

#include <string>

namespace apsis::app {

/// Returns the gas, its reference state and the units of the case, one quantity per line.
std::string scales_text(const gas_scales& scales);

/// Returns the table of ε, δ and the Knudsen numbers in every definition, for a viscosity
/// exponent. Dimensionless.
std::string knudsen_text(double epsilon, double viscosity_exponent);

}  // namespace apsis::app
