#include <apsis/model/fluid_fields.hpp>

#include <apsis/velocity/component_name.hpp>

#include <cstddef>

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

std::vector<field_group> flow_fields(int dimensions) {
  // ∂u_k/∂x_l. Field 0 is ρ, so that u_k is field 1 + k.
  const auto slope = [](const field_point& at, int k, int l) {
    return at.gradients[1 + static_cast<std::size_t>(k)][static_cast<std::size_t>(l)];
  };
  const field_group divergence{
      {{"divergence", "divergence of the velocity (dimensionless)", dimensions::rate}},
      [=](const field_point& at, double* values) {
        *values = 0.0;
        for (int k = 0; k < dimensions; ++k) *values += slope(at, k, k);
      },
      true};
  if (dimensions == 1) return {divergence};
  field_group vorticity{{},
                        [=](const field_point& at, double* values) {
                          for (int k = dimensions == 2 ? 2 : 0; k < 3; ++k)
                            *values++ =
                                slope(at, (k + 2) % 3, (k + 1) % 3) - slope(at, (k + 1) % 3, (k + 2) % 3);
                        },
                        true};
  for (int k = 0; k < (dimensions == 2 ? 1 : 3); ++k) {
    const std::string along = dimensions == 2 ? "" : std::string(" along ") + "xyz"[k];
    vorticity.names.push_back({component_name("vorticity", k, dimensions == 2 ? 1 : 3),
                               "vorticity" + along + " (dimensionless)", dimensions::rate});
  }
  return {divergence, vorticity};
}

std::vector<std::string> fluid_invariants(int dimensions) {
  std::vector<std::string> names = {"mass"};
  for (int k = 0; k < dimensions; ++k) names.push_back(component_name("momentum", k, dimensions));
  names.emplace_back("energy");
  return names;
}

}  // namespace apsis
