#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <vector>

namespace apsis {

/// r ← r + σ (E(ω + share δω) − E(ω)) in cells of this process; `rates` are σ. The share is halved in cells
/// without an equilibrium of ω + share δω. Throws numerical_error with the cell if ω has no equilibrium.
void add_equilibrium_changes(const relaxation_model& equation, const problem_builder& space,
                             const std::vector<int>& cells, const std::vector<double>& omega,
                             const std::vector<double>& changes, double share,
                             const std::vector<double>& rates, field& r);

}  // namespace apsis
