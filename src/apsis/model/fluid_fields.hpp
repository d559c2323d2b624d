#pragma once

#include <apsis/model/maxwellian.hpp>
#include <apsis/model/model.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Returns the macroscopic fields of a gas with `dimensions` velocity components: rho, u (u_x, u_y, u_z if
/// there are several), T.
std::vector<field_name> fluid_fields(int dimensions);
/// values ← density, bulk velocity and temperature, in the order of fluid_fields(). Dimensionless.
void fluid_field_values(const fluid_state& state, int dimensions, double* values);

/// Returns further fields of a gas whose default fields begin with fluid_fields(). These are the divergence
/// ∇·u and, with several velocity components, the vorticity ∇×u. The vorticity is one number in two
/// dimensions and has x, y and z components in three.
std::vector<field_group> flow_fields(int dimensions);

/// Returns the names of the invariants ρ, ρu, 𝓔: mass, momentum (momentum_x, momentum_y, momentum_z if there
/// are several), energy.
std::vector<std::string> fluid_invariants(int dimensions);

}  // namespace apsis
