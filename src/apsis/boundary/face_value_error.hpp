#pragma once

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/core/errors.hpp>

#include <string>

namespace apsis {

/// An input error with the place in a case that gives a quantity at a face.
class face_value_error final : public input_error {
 public:
  using input_error::input_error;
};

/// Returns the surface of a quantity, such as "body 'disc'"; `otherwise` if no case gives the quantity.
std::string surface_of(const face_quantity& value, const std::string& otherwise);

/// Returns the time of a value and, if the value is a formula in a case, the point: "t = 0.5 near
/// (0.1, 0)". Dimensionless.
std::string time_and_point(const face_quantity& value, double t, const position& at);

/// Throws face_value_error with the place of a quantity, or input_error if no case gives the quantity.
[[noreturn]] void refuse_value(const face_quantity& value, const std::string& message);

}  // namespace apsis
