#include <apsis/config/internal/key_table.hpp>

namespace apsis {
namespace {

std::vector<case_key> force_keys() {
  return {
      key("force.acceleration", [](auto& c) -> auto& { return c.force.acceleration; },
          {.type = key_type::formulas,
           .scope = key_scope::velocity,
           .dimension = dimensions::velocity / dimensions::time,
           .doc = "Acceleration of the molecules, one formula for each velocity dimension; those that are "
                  "left out are 0. With a table [gas] they may have units, \"1e6 m/s^2\"."})};
}

}  // namespace

extern const key_table_entry key_table_force;
const key_table_entry key_table_force = {.place = 40, .keys = force_keys};

}  // namespace apsis
