#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

namespace apsis {

/// Returns the macroscopic fields of a state: the default fields of the model, and every further group of
/// fields from which the case names one. Such a group has fields at a point, or fields with gradients.
/// Gradients are central differences of second order. In cells at faces that are not periodic they are
/// one-sided, of first order.
field_table compute_fields(const run_setup& setup, const field& u);

}  // namespace apsis
