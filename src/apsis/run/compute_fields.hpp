#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

namespace apsis {

/// Returns the macroscopic fields of a state: the usual ones of the model, and all further ones of a group,
/// those at a point or those with gradients, if the case names one of the group. Gradients are central
/// differences of second order, one-sided of first order in the cells at faces that are not periodic.
field_table compute_fields(const run_setup& setup, const field& u);

}  // namespace apsis
