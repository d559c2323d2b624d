#include <apsis/core/index.hpp>
#include <apsis/mesh/internal/mesh_cutter.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace apsis {
namespace {

/// Open faces with a smaller relative difference of areas count as equal, so that mirrored meshes have
/// mirrored groups.
constexpr double equal_areas = 1e-9;
/// A cell that a wall halves from corner to corner has the outflow 1 up to rounding. Such a cell
/// joins others.
constexpr double largest_outflow = 1.0 - 1e-9;

}  // namespace

int mesh_cutter::root(int cell) {
  while (parents_[at(cell)] >= 0) cell = parents_[at(cell)];
  return cell;
}

/// The lowest cell of a group is its root.
void mesh_cutter::unite(int a, int b) {
  a = root(a), b = root(b);
  if (a != b) parents_[at(std::max(a, b))] = std::min(a, b);
}

std::map<int, std::vector<int>> mesh_cutter::members() {
  std::map<int, std::vector<int>> found;
  for (const auto& [cell, gas] : gas_) found[root(cell)].push_back(cell);
  return found;
}

/// Returns κ max Δx Σ_out area / volume.
double mesh_cutter::outflow(const std::vector<int>& cells) {
  std::array<double, 6> out{};
  double volume = 0.0;
  for (const int cell : cells) {
    const gas_of_cell& gas = gas_.at(cell);
    volume += gas.volume;
    for (const way_out& one : ways_out(cell))
      if (one.neighbour < 0 || root(one.neighbour) != root(cell))
        out[face{one.direction, one.upper}.index()] += one.area;
    for (const piece& wall : gas.walls)
      for (int k = 0; k < mesh_.dimensions(); ++k)
        out[face{k, wall.vector[at(k)] < 0.0}.index()] += std::abs(wall.vector[at(k)]);
  }
  double most = 0.0;
  for (int k = 0; k < mesh_.dimensions(); ++k)
    for (const bool upper : {false, true})
      most = std::max(most, out[face{k, upper}.index()] * mesh_.spacing(k));
  return cut_cells::cfl_number * most / volume;
}

/// Returns the roots of the neighbouring groups with the largest open area towards a group.
std::vector<mesh_cutter::candidate> mesh_cutter::best_neighbours(const std::vector<int>& cells) {
  struct open_part {
    double all = 0.0, largest = 0.0;
    int direction = 0;  ///< of the largest face; of equal ones, the first
  };
  std::map<int, open_part> areas;  // by root
  for (const int cell : cells)
    for (const way_out& one : ways_out(cell)) {
      if (one.neighbour < 0 || root(one.neighbour) == root(cell)) continue;
      open_part& here = areas[root(one.neighbour)];
      here.all += one.area;
      if (one.area * (1.0 - equal_areas) <= here.largest) continue;
      here.largest = one.area;
      here.direction = one.direction;
    }
  double largest = 0.0;
  for (const auto& [neighbour, area] : areas) largest = std::max(largest, area.all);
  std::vector<candidate> best;
  for (const auto& [neighbour, area] : areas)
    if (area.all >= (1.0 - equal_areas) * largest) best.push_back({neighbour, area.direction});
  return best;
}

/// Reduces the choices of small groups with several equally good neighbours. If another such group would join
/// one of these neighbours too, only neighbours in the first direction remain. Otherwise all groups along a
/// wall at 45° to the grid would become one group. Mirrored meshes have mirrored groups.
void mesh_cutter::break_chains(std::map<int, std::vector<candidate>>& wanted) {
  std::map<int, int> claims;
  for (const auto& [first, best] : wanted)
    for (const candidate& one : best)
      if (best.size() > 1) ++claims[one.cell];
  for (auto& [first, best] : wanted) {
    if (best.size() < 2 ||
        std::none_of(best.begin(), best.end(), [&](const candidate& one) { return claims.at(one.cell) > 1; }))
      continue;
    const auto before = [](const candidate& a, const candidate& b) { return a.direction < b.direction; };
    const int direction = std::min_element(best.begin(), best.end(), before)->direction;
    std::erase_if(best, [direction](const candidate& one) { return one.direction != direction; });
  }
}

/// Joins small cells to others in rounds. All cells of a round use the same state, so that the order of cells
/// does not matter.
void mesh_cutter::join() {
  for (bool changed = true; changed;) {
    changed = false;
    std::map<int, std::vector<candidate>> wanted;  // by root
    std::vector<int> closed;
    for (const auto& [first, cells] : members()) {
      if (outflow(cells) <= largest_outflow) continue;
      wanted[first] = best_neighbours(cells);
      if (wanted[first].empty()) closed.insert(closed.end(), cells.begin(), cells.end());
    }
    break_chains(wanted);
    for (const auto& [first, best] : wanted)
      for (const candidate& other : best) {
        for (const int cell : {first, other.cell})
          if (kinds_[at(cell)] == kind::whole) make_cut(cell);
        unite(first, other.cell);
        changed = true;
      }
    // A pocket of a few small cells without open faces becomes solid. No neighbour has a face towards it.
    for (const int cell : closed) {
      kinds_[at(cell)] = kind::body;
      result_.body_of_[at(cell)] = body_at(mesh_.centre(cell));
      gas_.erase(cell);
      changed = true;
    }
  }
}

void mesh_cutter::number_groups() {
  result_.group_of_.assign(at(mesh_.size()), -1);
  for (auto& [first, cells] : members()) {
    const int number = static_cast<int>(result_.groups_.size());
    for (const int cell : cells) {
      result_.group_of_[at(cell)] = number;
      result_.volumes_[cell] = gas_.at(cell).volume;
    }
    result_.outflows_.push_back(outflow(cells));
    result_.groups_.emplace_back().cells = std::move(cells);
  }
  for (int group = 0; group < static_cast<int>(result_.groups_.size()); ++group) find_centre(group);
  for (int group = 0; group < static_cast<int>(result_.groups_.size()); ++group) add_faces(group);
}

/// Computes the volume and centroid of a group. At periodic faces, coordinates of cells are shifted to the
/// side of the first cell of the group.
void mesh_cutter::find_centre(int number) {
  cut_group& group = result_.groups_[at(number)];
  std::vector<int> reached = {group.cells.front()};
  shifts_[reached.front()] = {};
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (const way_out& one : ways_out(reached[k])) {
      if (one.neighbour < 0 || result_.group_of(one.neighbour) != number || shifts_.count(one.neighbour) > 0)
        continue;
      const auto d = at(one.direction);
      position shift = shifts_.at(reached[k]);
      const double beside = mesh_.centre(reached[k])[d] + (one.upper ? 1 : -1) * mesh_.spacing(one.direction);
      const double length = mesh_.spacing(one.direction) * mesh_.cells(one.direction);
      shift[d] += length * std::round((beside - mesh_.centre(one.neighbour)[d]) / length);
      shifts_[one.neighbour] = shift;
      reached.push_back(one.neighbour);
    }
  position moment{};
  for (const int cell : group.cells) {
    const gas_of_cell& gas = gas_.at(cell);
    group.volume += gas.volume;
    for (std::size_t d = 0; d < 3; ++d) moment[d] += gas.volume * (gas.centre[d] + shifts_.at(cell)[d]);
  }
  for (std::size_t d = 0; d < 3; ++d) group.centre[d] = moment[d] / group.volume;
}

/// Adds the faces and walls of a group. A face between two groups is added with the group below it.
void mesh_cutter::add_faces(int number) {
  cut_group& group = result_.groups_[at(number)];
  const auto from_centre = [&](int cell, const position& x) {
    const int of = result_.group_of(cell);
    const position centre = of < 0 ? mesh_.centre(cell) : result_.groups_[at(of)].centre;
    const position shift = of < 0 ? position{} : shifts_.at(cell);
    position found{};
    for (std::size_t d = 0; d < 3; ++d) found[d] = x[d] + shift[d] - centre[d];
    return found;
  };
  for (const int cell : group.cells) {
    for (const way_out& one : ways_out(cell)) {
      const int other = one.neighbour < 0 ? -1 : result_.group_of(one.neighbour);
      if (one.neighbour >= 0 && (other == number || (other >= 0 && !one.upper))) continue;
      position beyond = one.middle;  // the middle in the coordinates of the neighbour
      if (one.neighbour >= 0)
        beyond[at(one.direction)] = mesh_.centre(one.neighbour)[at(one.direction)] -
                                    (one.upper ? 0.5 : -0.5) * mesh_.spacing(one.direction);
      open_face made{.below = one.upper ? cell : one.neighbour,
                     .above = one.upper ? one.neighbour : cell,
                     .direction = one.direction,
                     .area = one.area,
                     .middle = one.middle};
      if (made.below >= 0) made.from_below = from_centre(made.below, one.upper ? one.middle : beyond);
      if (made.above >= 0) made.from_above = from_centre(made.above, one.upper ? beyond : one.middle);
      if (one.neighbour < 0) made.corners = corners_of_closed(cell, one.direction, one.upper, true);
      const int index = static_cast<int>(result_.faces_.size());
      group.faces.push_back(index);
      if (other >= 0) result_.groups_[at(other)].faces.push_back(index);
      result_.faces_.push_back(made);
    }
    for (const piece& wall : gas_.at(cell).walls) {
      wall_segment made{.cell = cell, .solid = wall.solid, .middle = wall.middle, .corners = wall.corners};
      for (const double x : wall.vector) made.area += x * x;
      made.area = std::sqrt(made.area);
      for (std::size_t k = 0; k < 3; ++k) {
        made.normal[k] = wall.vector[k] / made.area;
        made.moment[k] = wall.moment[k] / made.area;
      }
      made.from_centre = from_centre(cell, wall.middle);
      group.walls.push_back(static_cast<int>(result_.walls_.size()));
      result_.walls_.push_back(made);
    }
  }
}

}  // namespace apsis
