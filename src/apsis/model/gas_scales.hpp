#pragma once

#include <apsis/model/dimension.hpp>
#include <apsis/model/gas_species.hpp>

#include <string>
#include <vector>

namespace apsis {

/// A quantity in SI units, with its name and dimension.
struct named_quantity {
  std::string name;                 ///< "number_density"
  double value = 0.0;               ///< value in unit_of(dimension)
  apsis::dimension dimension = {};  ///< its dimension
};

/// Reference state of a gas in SI units: ρ₀, T₀, √(RT₀) with R = k_B/m, and a length L. The units of all
/// dimensionless quantities follow from it.
class gas_scales {
 public:
  static constexpr double boltzmann = 1.380649e-23;  ///< k_B in J/K, exact in the SI of 2019

  /// Takes the pressure in Pa, the temperature in K and the reference length in m, all positive.
  gas_scales(gas_species gas, double pressure, double temperature, double length);

  const gas_species& gas() const { return gas_; }      ///< the gas
  double pressure() const { return pressure_; }        ///< p₀
  double temperature() const { return temperature_; }  ///< T₀
  double length() const { return length_; }            ///< L
  double gas_constant() const;                         ///< R = k_B/m
  double number_density() const;                       ///< n₀ = p₀/(k_B T₀)
  double density() const;                              ///< ρ₀ = m n₀
  double speed() const;                                ///< √(RT₀), unit of velocities
  double time() const { return length_ / speed(); }    ///< L/√(RT₀)
  double viscosity() const;                            ///< μ(T₀)
  /// Returns ε = μ(T₀) √(RT₀)/(p₀ L). The dimensionless viscosity is then ε T^ω.
  double epsilon() const;

  /// Returns the unit of a dimension in SI units, such as p₀ = ρ₀RT₀ for a pressure. A dimensionless quantity
  /// times its unit is the quantity in SI units.
  double unit(const dimension& d) const;

  /// Returns the reference state, the units, ε, δ, and the Knudsen numbers by every definition as
  /// "knudsen_viscosity", ….
  std::vector<named_quantity> quantities() const;

 private:
  gas_species gas_;
  double pressure_, temperature_, length_;
};

}  // namespace apsis
