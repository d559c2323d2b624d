#include <validation/graded_plates.hpp>

#include <fmt/format.h>
#include <validation/quantity.hpp>

namespace apsis::validation {

std::string graded_plates::place_formula() const {
  return fmt::format("({}*x + {}*(3*x^2 - 2*x^3))", b_, 1.0 - b_);
}

std::string graded_plates::slope_formula() const {
  return fmt::format("({} + {}*x*(1 - x))", b_, 6.0 * (1.0 - b_));
}

std::vector<std::string> between_plates(const std::map<std::string, std::string>& parameters) {
  return {"parameters.delta=" + parameters.at("delta"), "model.name=" + parameters.at("model"),
          fmt::format("model.epsilon=1/(sqrt(2)*delta*{})", plate_cells.slope_formula()), "space.cells=640",
          steady_state};
}

}  // namespace apsis::validation
