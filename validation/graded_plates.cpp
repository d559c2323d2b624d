#include <validation/graded_plates.hpp>

#include <fmt/format.h>

namespace apsis::validation {

std::string graded_plates::place_formula() const {
  return fmt::format("({}*x + {}*(3*x^2 - 2*x^3))", b_, 1.0 - b_);
}

std::string graded_plates::slope_formula() const {
  return fmt::format("({} + {}*x*(1 - x))", b_, 6.0 * (1.0 - b_));
}

}  // namespace apsis::validation
