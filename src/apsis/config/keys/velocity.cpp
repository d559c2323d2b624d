#include <apsis/config/internal/key_table.hpp>
#include <apsis/velocity/velocity_line_registry.hpp>

#include <algorithm>
#include <utility>

namespace apsis {
namespace {

/// Returns the key for axisymmetric cases.
case_key if_axisymmetric(case_key of) {
  return only_if([](const case_config& c) { return c.is_axisymmetric(); }, std::move(of));
}

bool needs_max(const std::string& name) {
  const velocity_line_entry* entry = try_find_velocity_line(name);
  return entry != nullptr && entry->needs_max;
}

/// Returns whether velocity.set is given and no name in it has a property.
bool no_set_is(const case_config& c, bool (*property)(const std::string&)) {
  return !c.velocity.set.empty() && std::none_of(c.velocity.set.begin(), c.velocity.set.end(), property);
}

std::vector<case_key> velocity_keys() {
  return {
      if_given(key(
          "velocity.set", [](auto& c) -> auto& { return c.velocity.set; },
          {.scope = key_scope::velocity,
           .choices = names_in(velocity_line_entries),
           .doc =
               "Velocities along each direction (a list, or one set for all): \"uniform\" where not given, "
               "or a file NAME.csv or NAME.txt of velocities and weights (relative to where the program "
               "runs)."})),
      if_given(key(
          "velocity.max", [](auto& c) -> auto& { return c.velocity.max; },
          {.scope = key_scope::velocity,
           .required = true,
           .optional = [](const case_config& c) { return no_set_is(c, needs_max); },
           .dimension = dimensions::velocity,
           .lowest = 0.0,
           .highest = 1e6,
           .lowest_excluded = true,
           .doc = "Largest velocity: the grid covers [-max, max], which must hold the tails of the data."})),
      if_given(key("velocity.points", [](auto& c) -> auto& { return c.velocity.points; },
                   {.scope = key_scope::velocity,
                    .required = true,
                    .optional =
                        [](const case_config& c) {
                          return no_set_is(c,
                                           [](const std::string& name) { return !is_velocity_file(name); });
                        },
                    .lowest = 4,
                    .highest = 100'000,
                    .doc = "Number of velocities along each direction: a list, or one number for all."})),
      if_axisymmetric(
          key("velocity.rings", [](auto& c) -> auto& { return c.velocity.rings; },
              {.scope = key_scope::velocity,
               .lowest = 4,
               .highest = 10'000,
               .doc = "Rings of velocities about the axis of axisymmetric flow, up to the largest "
                      "velocity. The set and the points are those along the axis."})),
      if_axisymmetric(key("velocity.angles", [](auto& c) -> auto& { return c.velocity.angles; },
                          {.scope = key_scope::velocity,
                           .lowest = 12,
                           .highest = 10'000,
                           .doc = "Velocities on each ring, a multiple of 4."})),
      if_axisymmetric(key("velocity.max_across", [](auto& c) -> auto& { return c.velocity.max_across; },
                          {.scope = key_scope::velocity,
                           .dimension = dimensions::velocity,
                           .lowest = 0.0,
                           .highest = 1e6,
                           .lowest_excluded = true,
                           .doc = "Largest velocity of the rings; velocity.max where not given."})),
      key("velocity.equilibrium", [](auto& c) -> auto& { return c.velocity.equilibrium; },
          {.scope = key_scope::velocity,
           .doc = "Maxwellian by its formula, or with the discrete moments matched (conservative on any "
                  "grid); auto measures which is needed."})};
}

}  // namespace

extern const key_table_entry key_table_velocity;
const key_table_entry key_table_velocity = {.place = 50, .keys = velocity_keys};

}  // namespace apsis
