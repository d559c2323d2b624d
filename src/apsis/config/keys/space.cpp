#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/discretization_of_case.hpp>
#include <apsis/config/internal/key_table.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

namespace apsis {
namespace {

std::vector<case_key> space_keys() {
  return {
      key("space.cells", [](auto& c) -> auto& { return c.space.cells; },
          {.scope = key_scope::space,
           .required = true,
           .lowest = 1,
           .highest = 10'000'000,
           .doc = "Number of cells of equal size; in several dimensions a list, one number for each "
                  "direction."}),
      key("space.domain", [](auto& c) -> auto& { return c.space.domain; },
          {.scope = key_scope::space,
           .dimension = dimensions::length,
           .doc = "Lower and upper end of the domain, [lower, upper] with lower < upper; in several "
                  "dimensions a list of such pairs."}),
      key("space.blocks", [](auto& c) -> auto& { return c.space.blocks; },
          {.scope = key_scope::space,
           .lowest = 1,
           .highest = 10'000'000,
           .doc = "Number of blocks of cells in each direction, one block for each process; by default those "
                  "with the least to send."}),
      key("space.geometry", [](auto& c) -> auto& { return c.space.geometry; },
          {.scope = key_scope::velocity,
           .doc =
               "axisymmetric: nothing depends on the angle about an axis. The last coordinate, y of two or x "
               "of one, is the distance r >= 0 from the axis; velocities are those along x, r and the "
               "angle, in one dimension along r, the angle and the axis. Point values only "
               "(docs/axisymmetric.md)."}),
      key(discretization_key, [](auto& c) -> auto& { return c.space.discretization; },
          {.scope = key_scope::space,
           .choices = [](const case_config&) { return discretization_names(); },
           .doc =
               "Unknowns are cell averages (finite-volume) or point values (finite-difference; about a third "
               "of the cost of cell averages with collisions at Gauss points)."}),
      key("space.collisions", [](auto& c) -> auto& { return c.space.collisions; },
          {.scope = key_scope::space,
           .choices = [](const case_config&) { return collision_place_names(); },
           .doc =
               "Where cell averages collide: gauss: three Gauss points of each cell, on its reconstruction; "
               "centres: values at cell centres that all averages together imply, of fourth order in space, "
               "with a third of the solves. gauss where not given."}),
      key("space.reconstruction", [](auto& c) -> auto& { return c.space.reconstruction; },
          {.scope = key_scope::space,
           .choices = names_in(reconstruction_entries),
           .doc = "Reconstruction scheme."}),
      key("space.limiter", [](auto& c) -> auto& { return c.space.limiter; },
          {.scope = key_scope::space,
           .doc =
               "positivity: limit fluxes so that nonnegative data stay nonnegative for steps up to the "
               "method's SSP coefficient times dx/v_max, at no cost in steps; cell averages with collisions "
               "at Gauss points need their edge values limited, and steps 12 times shorter. Where not given: "
               "positivity where f >= 0 can be kept at no cost in steps, else none."}),
      key("space.boundary", [](auto& c) -> auto& { return c.space.boundary; },
          {.scope = key_scope::space,
           .choices = names_in(boundary_entries),
           .doc = "Boundary condition at every end of the domain (apsis list boundaries). Entropy decay is "
                  "promised for periodic ends only."})};
}

}  // namespace

extern const key_table_entry key_table_space;
const key_table_entry key_table_space = {.place = 30, .keys = space_keys};

}  // namespace apsis
