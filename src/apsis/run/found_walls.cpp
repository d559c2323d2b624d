#include <apsis/run/found_walls.hpp>

#include <apsis/boundary/wall_temperature.hpp>

namespace apsis {

std::vector<found_wall> found_walls(const run_setup& setup) {
  std::vector<found_wall> all;
  if (!setup.has_space()) return all;
  const auto names = setup.open_faces();
  const domain& space = setup.builder().space();
  for (std::size_t k = 0; k < space.budget_surfaces().size(); ++k) {
    const budget_surface& one = space.budget_surfaces()[k];
    const auto* wall = dynamic_cast<const wall_temperature*>(&space.boundary_at(one).undecorated());
    if (wall != nullptr && wall->follows_from_gas()) all.push_back({names[k], k, one.solid < 0});
  }
  return all;
}

std::vector<std::string> temperature_columns(const run_setup& setup) {
  std::vector<std::string> columns;
  for (const found_wall& wall : found_walls(setup)) columns.push_back("T_w_" + wall.name);
  return columns;
}

}  // namespace apsis
