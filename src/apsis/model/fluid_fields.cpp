#include <apsis/model/fluid_fields.hpp>

#include <apsis/velocity/component_name.hpp>

namespace apsis {

std::vector<field_name> fluid_fields(int dimensions) {
  std::vector<field_name> fields = {{"rho", "density (dimensionless)", dimensions::density}};
  for (int k = 0; k < dimensions; ++k) {
    const std::string along = dimensions == 1 ? "" : std::string(" along ") + "xyz"[k];
    fields.push_back({component_name("u", k, dimensions), "bulk velocity" + along + " (dimensionless)",
                      dimensions::velocity});
  }
  fields.push_back({"T", "temperature (dimensionless)", dimensions::temperature});
  return fields;
}

void fluid_field_values(const fluid_state& state, int dimensions, double* values) {
  values[0] = state.rho;
  for (int k = 0; k < dimensions; ++k) values[1 + k] = state.u[k];
  values[1 + dimensions] = state.T;
}

std::vector<std::string> fluid_invariants(int dimensions) {
  std::vector<std::string> names = {"mass"};
  for (int k = 0; k < dimensions; ++k) names.push_back(component_name("momentum", k, dimensions));
  names.emplace_back("energy");
  return names;
}

}  // namespace apsis
