#include <apsis/config/discretization_of_case.hpp>

namespace apsis {

std::string discretization_override(const std::string& name) {
  return discretization_key + ("=" + name);
}

const discretization& discretization_of(const case_config& config) {
  return find_discretization(config.space.discretization).instance();
}

}  // namespace apsis
