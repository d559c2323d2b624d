#pragma once

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/core/errors.hpp>

#include <string>

namespace apsis {

/// An input error whose message names the place in a case that gives a quantity at a face.
class face_value_error final : public input_error {
 public:
  using input_error::input_error;
};

/// Returns the surface of a quantity, "body 'disc'"; `otherwise` if no case gives the quantity.
std::string surface_of(const face_quantity& value, const std::string& otherwise);

/// Returns the time of a value, and the point if the value is a formula in a case: "t = 0.5 near (0.1, 0)".
/// Dimensionless.
std::string time_and_point(const face_quantity& value, double t, const position& at);

/// Throws face_value_error at the place of a quantity; input_error if no case gives it.
[[noreturn]] void refuse_value(const face_quantity& value, const std::string& message);

}  // namespace apsis
