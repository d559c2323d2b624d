#include <apsis/config/case_units.hpp>

#include <apsis/core/errors.hpp>

#include <fmt/format.h>

namespace apsis {

double in_units_of_case(double value, const std::string& unit, const std::string& name,
                        const dimension& wanted, const std::optional<gas_scales>& scales) {
  if (unit.empty() || unit == unit_of(dimensions::none)) return value;
  if (!scales)
    throw input_error(
        fmt::format("{} has the unit {} (a unit needs the scales of a gas); add a table [gas], or give "
                    "dimensionless numbers",
                    name, unit));
  quantity one;
  try {
    one = parse_quantity(fmt::format("{} {}", value, unit), {});
  } catch (const input_error& problem) {
    throw input_error(fmt::format("{}: {}", name, problem.what()));
  }
  if (wanted == dimensions::density && one.unit == dimensions::number_density)
    one = {one.value * scales->gas().mass, dimensions::density};
  if (one.unit != wanted)
    throw input_error(fmt::format("{} has the unit of {} (that of {} is needed); change it", name,
                                  unit_of(one.unit), unit_of(wanted)));
  return one.value / scales->unit(one.unit);
}

}  // namespace apsis
