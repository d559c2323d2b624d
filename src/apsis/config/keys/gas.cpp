#include <apsis/config/internal/key_table.hpp>
#include <apsis/model/gas_species.hpp>

#include <utility>

namespace apsis {
namespace {

/// Returns the key of a quantity of the table [gas].
template <class At>
case_key gas_quantity(std::string path, At at, dimension dims, const std::string& doc) {
  return key(std::move(path), at,
             {.type = key_type::quantity,
              .scope = key_scope::velocity,
              .unit = unit_of(dims),
              .dimension = dims,
              .doc = doc});
}

std::vector<case_key> gas_keys() {
  return {
      key("gas.name", [](auto& c) -> auto& { return c.gas.name; },
          {.scope = key_scope::velocity,
           .choices = [](const case_config&) { return gas_names(); },
           .doc = "A known gas, whose mass, viscosity, viscosity exponent, Prandtl number and degrees of "
                  "freedom hold unless given. A table [gas] permits units in all quantities of the case, and "
                  "sets the model to this gas."}),
      gas_quantity(
          "gas.mass", [](auto& c) -> auto& { return c.gas.mass; }, dimensions::mass, "Mass of a molecule."),
      gas_quantity(
          "gas.viscosity", [](auto& c) -> auto& { return c.gas.viscosity; }, dimensions::viscosity,
          "Viscosity at gas.viscosity_temperature."),
      gas_quantity(
          "gas.viscosity_temperature", [](auto& c) -> auto& { return c.gas.viscosity_temperature; },
          dimensions::temperature,
          "Temperature of the viscosity; gas.temperature where only gas.viscosity is given."),
      key("gas.viscosity_exponent", [](auto& c) -> auto& { return c.gas.viscosity_exponent; },
          {.scope = key_scope::velocity,
           .lowest = 0.0,
           .highest = 2.0,
           .doc = "Exponent w of the viscosity mu ~ T^w."}),
      key("gas.prandtl", [](auto& c) -> auto& { return c.gas.prandtl; },
          {.scope = key_scope::velocity,
           .lowest = 0.0,
           .lowest_excluded = true,
           .doc = "Prandtl number; that of Eucken's formula, 2/3 of a monatomic gas, where not given."}),
      key("gas.degrees_of_freedom", [](auto& c) -> auto& { return c.gas.degrees_of_freedom; },
          {.scope = key_scope::velocity,
           .lowest = 1,
           .highest = 100,
           .doc = "Degrees of freedom of a molecule; 3 without a name."}),
      gas_quantity(
          "gas.pressure", [](auto& c) -> auto& { return c.gas.pressure; }, dimensions::pressure,
          "Reference pressure. Exactly one of pressure, density and number_density is given."),
      gas_quantity(
          "gas.density", [](auto& c) -> auto& { return c.gas.density; }, dimensions::density,
          "Reference density, in place of the pressure."),
      gas_quantity(
          "gas.number_density", [](auto& c) -> auto& { return c.gas.number_density; },
          dimensions::number_density, "Reference number density, in place of the pressure."),
      gas_quantity(
          "gas.temperature", [](auto& c) -> auto& { return c.gas.temperature; }, dimensions::temperature,
          "Reference temperature, required; in K, or in degC."),
      gas_quantity(
          "gas.length", [](auto& c) -> auto& { return c.gas.length; }, dimensions::length,
          "Reference length, the unit of x; required."),
  };
}

}  // namespace

extern const key_table_entry key_table_gas;
const key_table_entry key_table_gas = {.place = 20, .keys = gas_keys};

}  // namespace apsis
