#pragma once

#include <apsis/config/case.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Returns a small case defined by the entry of a model alone, with its first initial data and default
/// parameters. It has 16 cells on [0, 2], and 60 velocities if the model has a velocity grid. It runs to t =
/// 8 Δt with Δt = Δx/2 over the largest speed (1/32 without space). ε is 1 and the method md-imex-6-3;
/// `overrides` "key=value" change other keys.
case_config small_case(const std::string& model, const std::vector<std::string>& overrides = {});

/// Returns the names of the models of the registry whose collision is a relaxation.
std::vector<std::string> relaxation_model_names();

/// Returns the discretizations with a limit scheme (limit_space): "finite-volume" and "finite-difference";
/// only "" for a model without space.
std::vector<std::string> formulation_names(const std::string& model);

/// Returns the override that sets the discretization (discretization_override()); an empty list for "".
std::vector<std::string> formulation_override(const std::string& discretization);

}  // namespace apsis
