#include <apsis/model/dimension.hpp>

#include <array>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Dimensions whose unit has a name or a usual form.
constexpr std::array<std::pair<dimension, const char*>, 5> usual_units = {
    {{dimensions::none, "dimensionless"},
     {dimensions::pressure, "Pa"},
     {dimensions::viscosity, "Pa s"},
     {dimensions::heat_flux, "W/m^2"},
     {dimensions::pressure * dimensions::length, "J/m^2"}}};

}  // namespace

std::string unit_of(const dimension& d) {
  for (const auto& [one, unit] : usual_units)
    if (one == d) return unit;
  const std::array<std::pair<const char*, int>, 4> factors = {
      {{"kg", d.mass}, {"m", d.length}, {"s", d.time}, {"K", d.temperature}}};
  std::string above, below;
  int count_below = 0;
  for (const auto& [symbol, exponent] : factors) {
    if (exponent == 0) continue;
    const int power = exponent < 0 ? -exponent : exponent;
    std::string& side = exponent > 0 ? above : below;
    if (!side.empty()) side += ' ';
    side += power == 1 ? symbol : fmt::format("{}^{}", symbol, power);
    if (exponent < 0) ++count_below;
  }
  if (above.empty()) above = "1";
  if (count_below == 0) return above;
  return count_below == 1 ? fmt::format("{}/{}", above, below) : fmt::format("{}/({})", above, below);
}

}  // namespace apsis
