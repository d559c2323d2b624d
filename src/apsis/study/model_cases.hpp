#pragma once

#include <apsis/config/case.hpp>

#include <string>
#include <vector>

namespace apsis {

/// A small case defined by the entry of a model alone: its first initial data and default parameters, on [0,
/// 2] with 16 cells and 60 velocities if it has them, to t = 8 Δt with Δt = Δx/2 over the largest speed (1/32
/// without space). ε = 1, method md-imex-6-3; overrides "key=value" change other keys.
case_config small_case(const std::string& model, const std::vector<std::string>& overrides = {});

/// Names of the models of the registry whose collision is a relaxation.
std::vector<std::string> relaxation_model_names();

/// The discretizations with a limit scheme (limit_space): "finite-volume" and "finite-difference"; "" alone
/// for a model without space.
std::vector<std::string> formulation_names(const std::string& model);

/// The override that sets the discretization (discretization_override()); none for "".
std::vector<std::string> formulation_override(const std::string& discretization);

}  // namespace apsis
