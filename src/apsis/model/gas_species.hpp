#pragma once

#include <string>
#include <vector>

namespace apsis {

/// Properties of a gas whose viscosity is μ(T) = μ_ref (T/T_ref)^ω.
struct gas_species {
  std::string name;                    ///< name in a case file (gas.name)
  double mass = 0.0;                   ///< m of a molecule in kg
  double viscosity = 0.0;              ///< μ_ref in Pa s
  double viscosity_temperature = 0.0;  ///< T_ref in K
  double viscosity_exponent = 0.5;     ///< ω
  int degrees_of_freedom = 3;          ///< D of translation and rotation
  double prandtl = 0.0;                ///< Pr
};

/// Returns Eucken's Prandtl number 4γ/(9γ − 5) with γ = (D + 2)/D: 2/3 for D = 3 (Chapman & Cowling, The
/// Mathematical Theory of Non-uniform Gases, 3rd ed., 13.3).
double eucken_prandtl(int degrees_of_freedom);

/// Returns the gases that a case can name, sorted by name. Mass, ω, degrees of freedom, and μ at 273 K and 1
/// atm are those of Bird, Molecular Gas Dynamics and the Direct Simulation of Gas Flows, Oxford 1994,
/// appendix A. Pr is eucken_prandtl().
const std::vector<gas_species>& known_gases();

/// Returns the names of known_gases().
std::vector<std::string> gas_names();

/// Returns the gas called `name`; nullptr for an unknown name.
const gas_species* try_find_gas(const std::string& name);

}  // namespace apsis
