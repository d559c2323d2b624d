#pragma once

#include <apsis/run/simulation.hpp>

#include <array>
#include <vector>

namespace apsis {

/// ρ, ρu and 𝓔 = ρ(u² + T)/2 of every cell. Their cell averages are averages of those of finer
/// cells. Dimensionless.
using conserved_fields = std::array<std::vector<double>, 3>;

/// Returns the conserved fields from rho, u and T of kinetic models with one velocity dimension. Throws
/// input_error if one of these is missing.
conserved_fields conserved(const field_table& macroscopic);

/// Returns averages over pairs of cells, for comparison with a mesh of half as many cells.
conserved_fields averaged_in_pairs(const conserved_fields& fine);

/// Returns the largest difference over fields and cells; NaN if a value is NaN.
double largest_difference(const conserved_fields& a, const conserved_fields& b);

}  // namespace apsis
