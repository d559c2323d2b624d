#include <apsis/model/gas_scales.hpp>

#include <apsis/model/mean_free_path.hpp>

#include <cmath>
#include <utility>

namespace apsis {

gas_scales::gas_scales(gas_species gas, double pressure, double temperature, double length)
    : gas_(std::move(gas)), pressure_(pressure), temperature_(temperature), length_(length) {}

double gas_scales::gas_constant() const {
  return boltzmann / gas_.mass;
}

double gas_scales::number_density() const {
  return pressure_ / (boltzmann * temperature_);
}

double gas_scales::density() const {
  return gas_.mass * number_density();
}

double gas_scales::speed() const {
  return std::sqrt(gas_constant() * temperature_);
}

double gas_scales::viscosity() const {
  return gas_.viscosity * std::pow(temperature_ / gas_.viscosity_temperature, gas_.viscosity_exponent);
}

double gas_scales::epsilon() const {
  return viscosity() * speed() / (pressure_ * length_);
}

double gas_scales::unit(const dimension& d) const {
  // Powers of ρ₀, L, √(RT₀) and T₀: kg = ρ₀ L³, s = L/√(RT₀).
  return std::pow(density(), d.mass) * std::pow(length_, 3 * d.mass + d.length + d.time) *
         std::pow(speed(), -d.time) * std::pow(temperature_, d.temperature);
}

std::vector<named_quantity> gas_scales::quantities() const {
  std::vector<named_quantity> all = {{"pressure", pressure_, dimensions::pressure},
                                     {"temperature", temperature_, dimensions::temperature},
                                     {"length", length_, dimensions::length},
                                     {"density", density(), dimensions::density},
                                     {"number_density", number_density(), dimensions::number_density},
                                     {"velocity", speed(), dimensions::velocity},
                                     {"time", time(), dimensions::time},
                                     {"heat_flux", unit(dimensions::heat_flux), dimensions::heat_flux},
                                     {"viscosity", viscosity(), dimensions::viscosity},
                                     {"viscosity_exponent", gas_.viscosity_exponent},
                                     {"prandtl", gas_.prandtl},
                                     {"degrees_of_freedom", static_cast<double>(gas_.degrees_of_freedom)},
                                     {"epsilon", epsilon()},
                                     {"rarefaction", rarefaction_of_epsilon(epsilon())}};
  for (const auto& one : mean_free_paths())
    all.push_back({"knudsen_" + one.name, one.knudsen_of_epsilon(gas_.viscosity_exponent) * epsilon()});
  return all;
}

}  // namespace apsis
