#pragma once

#include <apsis/model/maxwellian.hpp>
#include <apsis/model/model.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Macroscopic fields of a gas with `dimensions` velocity components: rho, u (u_x, u_y, u_z if there are
/// several), T.
std::vector<field_name> fluid_fields(int dimensions);
/// values ← density, the components of the bulk velocity, temperature, in the order of fluid_fields().
void fluid_field_values(const fluid_state& state, int dimensions, double* values);

/// Further fields of a gas whose default fields begin with fluid_fields(): the divergence ∇·u and, with
/// several velocity components, the vorticity ∇×u: one number in two dimensions, x, y and z components in
/// three.
std::vector<field_group> flow_fields(int dimensions);

/// Names of the invariants ρ, ρu, 𝓔: mass, momentum (momentum_x, momentum_y, momentum_z if there are
/// several), energy.
std::vector<std::string> fluid_invariants(int dimensions);

}  // namespace apsis
