#include <apsis/run/wall_outlines.hpp>

#include <apsis/core/index.hpp>
#include <apsis/mesh/cut_cells.hpp>

#include <algorithm>
#include <utility>

namespace apsis {

std::vector<position> corners_of_end(const domain& space, int surface, int place) {
  const grid& mesh = space.mesh();
  const int dimensions = mesh.dimensions();
  std::vector<position> corners;
  if (dimensions < 2) return corners;
  const face where = space.surfaces()[at(surface)].where;
  const int cell = space.cell_at(surface, place);
  const auto edge = [&](int k, int beyond) {
    return mesh.edge(k, cell / mesh.stride(k) % mesh.cells(k) + beyond);
  };
  const int d = where.direction, first = (d + 1) % dimensions, second = (d + 2) % 3;
  const auto add = [&](int of_first, int of_second) {
    position corner{};
    corner[at(d)] = edge(d, where.upper ? 1 : 0);
    corner[at(first)] = edge(first, of_first);
    if (dimensions == 3) corner[at(second)] = edge(second, of_second);
    corners.push_back(corner);
  };
  if (dimensions == 2)
    for (const int k : {0, 1}) add(k, 0);
  else
    for (const auto& [k, j] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) add(k, j);
  if (dimensions == 2 ? where.upper == (d == 0) : where.upper) std::reverse(corners.begin(), corners.end());
  return corners;
}

std::vector<wall_outline> wall_outlines(const run_setup& setup, double unit_of_length) {
  std::vector<wall_outline> outlines;
  if (!setup.has_space() || setup.whole_mesh().dimensions() < 2) return outlines;
  const domain& space = setup.builder().whole_space();
  const auto boxes = static_cast<int>(setup.config().solids.size());
  for (const budget_surface& one : space.budget_surfaces()) {
    if (one.solid < boxes) continue;
    wall_outline& made = outlines.emplace_back();
    made.name = setup.config().bodies[at(one.solid - boxes)].name;
    made.dimensions = space.mesh().dimensions();
    for (const int number : one.surfaces)
      for (int place = 0; place < static_cast<int>(space.surfaces()[at(number)].segments.size()); ++place)
        made.corners.push_back(corners_of_end(space, number, place));
    for (const int number : one.walls)
      made.corners.push_back(space.mesh().cut()->walls()[at(number)].corners);
    for (auto& piece : made.corners)
      for (position& end : piece)
        for (double& x : end) x *= unit_of_length;
  }
  return outlines;
}

}  // namespace apsis
