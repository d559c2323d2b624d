#pragma once

#include <apsis/config/case.hpp>
#include <apsis/semidiscrete/discretization_registry.hpp>

#include <string>

namespace apsis {

/// Key of case_config::space.discretization.
inline constexpr const char* discretization_key = "space.formulation";

/// Returns the override of a case that sets its discretization.
std::string discretization_override(const std::string& name);

/// Returns the discretization of a case. Throws input_error for an unknown name.
const discretization& discretization_of(const case_config& config);

}  // namespace apsis
