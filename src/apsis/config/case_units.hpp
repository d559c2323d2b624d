#pragma once

#include <apsis/config/quantity.hpp>
#include <apsis/model/gas_scales.hpp>

#include <optional>
#include <string>

namespace apsis {

/// Returns a number of a file in units of the case. `unit` is "" or "dimensionless" for a number without a
/// unit. `name` is the name of the number in messages. Throws input_error without a place for a unit without
/// scales, an unknown unit, or a unit of another dimension than `wanted`.
double in_units_of_case(double value, const std::string& unit, const std::string& name,
                        const dimension& wanted, const std::optional<gas_scales>& scales);

}  // namespace apsis
