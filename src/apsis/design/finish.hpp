#pragma once

#include <apsis/design/search.hpp>
#include <apsis/method/method.hpp>

#include <string>

namespace apsis {

/// A found method as a method file says it, with the digits of double precision: zeros and coefficients on a
/// bound are exact, the others decimals. Claims: the order that was asked for, and r.
method to_method(const design_task& task, const design_candidate& candidate, const std::string& name);

/// The same polished to `digits` decimals, by Newton's method on its order conditions and whatever else was
/// demanded, zeros and exact coefficients held (polish()). Throws numerical_error if that does not converge.
method to_polished_method(const design_task& task, const design_candidate& candidate, const std::string& name,
                          int digits = 45);

}  // namespace apsis
