#pragma once

#include <apsis/design/search.hpp>
#include <apsis/method/method.hpp>

#include <string>

namespace apsis {

/// Converts a candidate to a method with the digits of double precision: zeros and coefficients on a bound
/// are exact, all others decimals. Claims the order of the task, and r.
method to_method(const design_task& task, const design_candidate& candidate, const std::string& name);

/// Converts a candidate to a method polished to `digits` decimals. polish() solves the order conditions and
/// additional demands with zeros and exact coefficients fixed. Throws numerical_error if the iteration does
/// not converge.
method to_polished_method(const design_task& task, const design_candidate& candidate, const std::string& name,
                          int digits = 45);

/// Converts a candidate for a two-step method to a polished method (task.steps = 2, task.stages counts
/// u^{n−1}). Throws numerical_error if the iteration does not converge.
method to_polished_two_step_method(const design_task& task, const design_candidate& candidate,
                                   const std::string& name, int digits = 45);

}  // namespace apsis
