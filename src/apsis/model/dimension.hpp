#pragma once

#include <string>

namespace apsis {

/// Dimension of a quantity as exponents of the base units of the SI: kg^mass m^length s^time K^temperature.
struct dimension {
  int mass = 0,         ///< exponent of kg
      length = 0,       ///< exponent of m
      time = 0,         ///< exponent of s
      temperature = 0;  ///< exponent of K

  /// Whether all exponents are equal.
  friend constexpr bool operator==(const dimension&, const dimension&) = default;
  /// Returns the dimension of a product.
  friend constexpr dimension operator*(const dimension& a, const dimension& b) {
    return {a.mass + b.mass, a.length + b.length, a.time + b.time, a.temperature + b.temperature};
  }
  /// Returns the dimension of a quotient.
  friend constexpr dimension operator/(const dimension& a, const dimension& b) {
    return {a.mass - b.mass, a.length - b.length, a.time - b.time, a.temperature - b.temperature};
  }
};

/// Dimensions by name.
namespace dimensions {
inline constexpr dimension none{};                           ///< pure numbers
inline constexpr dimension mass{1, 0, 0, 0};                 ///< kg
inline constexpr dimension length{0, 1, 0, 0};               ///< m
inline constexpr dimension time{0, 0, 1, 0};                 ///< s
inline constexpr dimension temperature{0, 0, 0, 1};          ///< K
inline constexpr dimension rate = none / time;               ///< 1/s
inline constexpr dimension velocity = length / time;         ///< m/s
inline constexpr dimension number_density{0, -3, 0, 0};      ///< 1/m^3
inline constexpr dimension density = mass * number_density;  ///< kg/m^3
inline constexpr dimension mass_flux = density * velocity;   ///< kg/(m^2 s), momentum density too
inline constexpr dimension pressure = mass_flux * velocity;  ///< Pa, energy density too
inline constexpr dimension heat_flux = pressure * velocity;  ///< W/m^2
inline constexpr dimension viscosity = pressure * time;      ///< Pa s
}  // namespace dimensions

/// Returns the SI unit of a dimension: "Pa", "W/m^2", "kg/(m^2 s)"; "dimensionless" for a number.
std::string unit_of(const dimension& d);
/// Returns the SI unit of an amount of mass, momentum or energy, or of its change per unit of time. The
/// domain has `lacking` fewer directions than space, so that amounts are per length or area. In the plane
/// (`lacking` = 1) a force per length is in "N/m". unit_of() returns "J/m^2" for this dimension, which an
/// energy per area has too.
std::string unit_of_amount(const dimension& d, int lacking);
/// Returns the SI unit of a torque in a domain that lacks `lacking` directions: "N m" in space, "N m/m" in
/// the plane.
std::string unit_of_torque(int lacking);

}  // namespace apsis
