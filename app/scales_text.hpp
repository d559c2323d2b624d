#pragma once

#include <apsis/config/case.hpp>

#include <string>

namespace apsis::app {

/// Returns the gas, its reference state and the units of the case, one quantity a line.
std::string scales_text(const gas_scales& scales);

/// Returns the table of ε, δ and the Knudsen numbers by every definition, for a viscosity exponent.
std::string knudsen_text(double epsilon, double viscosity_exponent);

}  // namespace apsis::app
