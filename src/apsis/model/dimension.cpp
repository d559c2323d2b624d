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

/// Amounts in space, and their changes per unit of time, whose unit has a name.
constexpr std::array<std::pair<dimension, const char*>, 4> named_amounts = {
    {{dimensions::mass * dimensions::velocity, "N s"},
     {dimensions::mass * dimensions::velocity / dimensions::time, "N"},
     {dimensions::mass * dimensions::velocity * dimensions::velocity, "J"},
     {dimensions::mass * dimensions::velocity * dimensions::velocity / dimensions::time, "W"}}};

/// Returns a product of powers of the base units.
std::string in_base_units(const dimension& d) {
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

/// Returns a unit per `lengths` lengths: "N" becomes "N/m" or "N/m^2".
std::string per_lengths(const std::string& unit, int lengths) {
  if (lengths == 0) return unit;
  return lengths == 1 ? unit + "/m" : fmt::format("{}/m^{}", unit, lengths);
}

}  // namespace

std::string unit_of(const dimension& d) {
  for (const auto& [one, unit] : usual_units)
    if (one == d) return unit;
  return in_base_units(d);
}

std::string unit_of_amount(const dimension& d, int lacking) {
  if (d == dimensions::pressure || d == dimensions::none) return unit_of(d);
  dimension in_space = d;
  for (int k = 0; k < lacking; ++k) in_space = in_space * dimensions::length;
  for (const auto& [one, unit] : named_amounts)
    if (one == in_space) return per_lengths(unit, lacking);
  return in_base_units(d);
}

std::string unit_of_torque(int lacking) {
  return per_lengths("N m", lacking);
}

}  // namespace apsis
