#include <apsis/model/gas_species.hpp>

#include <algorithm>

namespace apsis {

double eucken_prandtl(int degrees_of_freedom) {
  // Expressed in D, so that D = 3 gives the nearest double to 2/3.
  return 2.0 * (degrees_of_freedom + 2.0) / (2.0 * degrees_of_freedom + 9.0);
}

const std::vector<gas_species>& known_gases() {
  static const std::vector<gas_species> gases = [] {
    // name, m [kg], μ_ref [Pa s], T_ref [K], ω, D
    std::vector<gas_species> table = {
        {"air", 48.1e-27, 1.719e-5, 273.0, 0.77, 5},    {"argon", 66.3e-27, 2.117e-5, 273.0, 0.81, 3},
        {"helium", 6.65e-27, 1.865e-5, 273.0, 0.66, 3}, {"krypton", 139.1e-27, 2.328e-5, 273.0, 0.80, 3},
        {"neon", 33.5e-27, 2.975e-5, 273.0, 0.66, 3},   {"nitrogen", 46.5e-27, 1.656e-5, 273.0, 0.74, 5},
        {"xenon", 218.0e-27, 2.107e-5, 273.0, 0.85, 3}};
    for (gas_species& one : table) one.prandtl = eucken_prandtl(one.degrees_of_freedom);
    return table;
  }();
  return gases;
}

std::vector<std::string> gas_names() {
  std::vector<std::string> names;
  for (const auto& one : known_gases()) names.push_back(one.name);
  return names;
}

const gas_species* try_find_gas(const std::string& name) {
  const auto& gases = known_gases();
  const auto found = std::find_if(gases.begin(), gases.end(), [&](const auto& g) { return g.name == name; });
  return found == gases.end() ? nullptr : &*found;
}

}  // namespace apsis
