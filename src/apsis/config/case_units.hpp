#pragma once

#include <apsis/config/quantity.hpp>
#include <apsis/model/gas_scales.hpp>

#include <optional>
#include <string>

namespace apsis {

/// Returns a number of a file in units of the case; `unit` is "" or "dimensionless" for one that is so
/// already. Throws input_error without a place: a unit without scales, an unknown one, or one of another
/// dimension than `wanted`. `name`: name of the number, for messages.
double in_units_of_case(double value, const std::string& unit, const std::string& name,
                        const dimension& wanted, const std::optional<gas_scales>& scales);

}  // namespace apsis
