#include <apsis/boundary/face_value_error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {

std::string surface_of(const face_quantity& value, const std::string& otherwise) {
  return value.origin() != nullptr ? value.origin()->surface : otherwise;
}

std::string time_and_point(const face_quantity& value, double t, const position& at) {
  std::string text = fmt::format("t = {:.10g}", t);
  if (value.origin() != nullptr && !value.is_constant())
    text +=
        fmt::format(" near ({:.6g})", fmt::join(at.begin(), at.begin() + value.origin()->dimensions, ", "));
  return text;
}

void refuse_value(const face_quantity& value, const std::string& message) {
  if (value.origin() == nullptr) throw input_error(message);
  throw face_value_error(value.origin()->place, message);
}

}  // namespace apsis
