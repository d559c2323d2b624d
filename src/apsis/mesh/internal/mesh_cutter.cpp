#include <apsis/mesh/internal/mesh_cutter.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/mesh/hidden_body.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

/// A cell with a smaller share of gas in its volume is solid.
constexpr double no_gas = 1e-15;
/// A cell with a larger share of gas in its volume is whole.
constexpr double all_gas = 1.0 - 1e-9;
/// Bodies are refused if they are too thin in a larger share of their cells. With a smaller share, only tips
/// are too thin.
constexpr double most_thin_cells = 0.2;
/// Bodies that lose a larger share of their volume between corners of cells are refused, because they would
/// have holes.
constexpr double largest_loss = 0.2;
/// The lost volume of a body with at most this number of cells is computed in all of its cells.
constexpr std::size_t cells_of_small_body = 64;

std::array<double, 3> cross(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// to ← to + by (x − from) × vector.
void add_moment(const position& x, const position& from, const std::array<double, 3>& vector, double by,
                std::array<double, 3>& to) {
  const std::array<double, 3> made = cross({x[0] - from[0], x[1] - from[1], x[2] - from[2]}, vector);
  for (std::size_t k = 0; k < 3; ++k) to[k] += by * made[k];
}

}  // namespace

mesh_cutter::mesh_cutter(const grid& mesh, const std::vector<outside_function>& bodies,
                         const std::array<bool, 3>& periodic, cut_cells& result)
    : mesh_(mesh),
      bodies_(bodies),
      periodic_(periodic),
      result_(result),
      phi_([this](const position& x) { return outside(x); }),
      parts_(mesh, phi_),
      kinds_(at(mesh.size()), kind::whole),
      parents_(at(mesh.size()), -1) {}

void mesh_cutter::cut() {
  check_periodic_faces();
  sort_cells();
  join();
  number_groups();
}

double mesh_cutter::outside(const position& x) const {
  double least = std::numeric_limits<double>::infinity();
  for (const outside_function& one : bodies_) {
    const double here = one(x);
    if (!(here >= least)) least = here;  // also true for NaN
  }
  return least;
}

int mesh_cutter::body_at(const position& x) const {
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < bodies_.size(); ++k)
    if (bodies_[k](x) < bodies_[nearest](x)) nearest = k;
  return static_cast<int>(nearest);
}

open_parts::corner mesh_cutter::lowest_corner(int cell) const {
  open_parts::corner c{};
  for (int k = 0; k < 3; ++k) c[at(k)] = cell / mesh_.stride(k) % mesh_.cells(k);
  return c;
}

int mesh_cutter::neighbour(int cell, int direction, bool upper) const {
  const int n = mesh_.cells(direction), here = cell / mesh_.stride(direction) % n;
  int there = here + (upper ? 1 : -1);
  if ((there < 0 || there >= n) && !periodic_[at(direction)]) return -1;
  there = (there + n) % n;
  return cell + (there - here) * mesh_.stride(direction);
}

/// Returns the open part of a face. Towards a cell without gas the part, which may be a sliver, is closed.
open_parts::part mesh_cutter::open_face_of(int cell, int direction, bool upper) {
  open_parts::corner corner = lowest_corner(cell);
  corner[at(direction)] += upper ? 1 : 0;
  open_parts::part part = parts_.face(direction, corner);
  if (const int beside = neighbour(cell, direction, upper); beside >= 0 && kinds_[at(beside)] == kind::body)
    part.share = 0.0;
  return part;
}

/// Throws input_error if a body that crosses a periodic face does not continue at the opposite one.
void mesh_cutter::check_periodic_faces() {
  // The coordinates of zeros of φ at the two faces differ by rounding.
  constexpr double equal_shares = 1e-9;
  for (int k = 0; k < mesh_.dimensions(); ++k) {
    if (!periodic_[at(k)]) continue;
    for (int pencil = 0; pencil < mesh_.pencils(k); ++pencil) {
      const int first = mesh_.first_cell(k, pencil), last = first + (mesh_.cells(k) - 1) * mesh_.stride(k);
      if (std::abs(share_of(first, k, false) - share_of(last, k, true)) <= equal_shares) continue;
      const position x = mesh_.centre(first);
      throw input_error(fmt::format(
          "a body crosses the periodic face at {} = {:.6g} near ({:.6g}), and does not continue at the "
          "opposite "
          "one (the domain is repeated there); add its image, as a union of both",
          "xyz"[k], mesh_.edge(k, 0), fmt::join(x.begin(), x.begin() + mesh_.dimensions(), ", ")));
    }
  }
}

/// Determines the kind of each cell.
void mesh_cutter::sort_cells() {
  std::vector<int> cut, thin, losing;
  result_.body_of_.assign(at(mesh_.size()), -1);
  for (int cell = 0; cell < mesh_.size(); ++cell) {
    const open_parts::corner corner = lowest_corner(cell);
    if (mesh_.solid(cell) >= 0) {
      kinds_[at(cell)] = kind::box;
      continue;
    }
    const auto state = parts_.of_cell(corner);
    if (state == open_parts::state::cut) cut.push_back(cell);
    if (state == open_parts::state::closed) kinds_[at(cell)] = kind::body;
    if (!parts_.may_be_thin(corner)) continue;
    const auto found = parts_.thin_in(corner);
    if (found.part == open_parts::thin_part::gap) parts_.refuse_as_thin("a gap between bodies", corner);
    if (found.part == open_parts::thin_part::body) thin.push_back(cell);
    if (found.loses) losing.push_back(cell);
  }
  check_thin_cells(thin, cut.size());
  for (const int cell : cut)
    if (measured(cell).volume < no_gas * mesh_.cell_volume()) kinds_[at(cell)] = kind::body;
  for (const int cell : cut)
    if (kinds_[at(cell)] != kind::body) add_cut_cell(cell);
  for (const int cell : cut)
    if (kinds_[at(cell)] == kind::whole) check_closed_faces(cell);
  bool any = false;
  for (int cell = 0; cell < mesh_.size(); ++cell) {
    any = any || is_gas(cell);
    if (kinds_[at(cell)] == kind::body) result_.body_of_[at(cell)] = body_at(mesh_.centre(cell));
  }
  check_bodies();
  check_lost_volume(losing);
  if (!any) throw input_error("no cell is left (all lie in bodies); give smaller bodies");
}

/// Throws hidden_body for a body without solid cells and walls.
void mesh_cutter::check_bodies() const {
  std::vector<bool> seen(bodies_.size(), false);
  const auto boxes = mesh_.solids().size();
  for (const int body : result_.body_of_)
    if (body >= 0) seen[at(body)] = true;
  for (const auto& [cell, gas] : gas_)
    for (const piece& wall : gas.walls)
      if (at(wall.solid) >= boxes) seen[at(wall.solid) - boxes] = true;
  for (std::size_t k = 0; k < seen.size(); ++k)
    if (!seen[k]) throw hidden_body(k, why_hidden(mesh_, bodies_[k]));
}

void mesh_cutter::check_thin_cells(const std::vector<int>& thin, std::size_t of_bodies) const {
  result_.thin_cells_ = static_cast<int>(thin.size());
  if (static_cast<double>(thin.size()) <= most_thin_cells * static_cast<double>(of_bodies)) return;
  // The message refers to the cell of median thickness, because tips have arbitrarily thin cells.
  std::vector<std::pair<double, int>> by_thickness;
  for (const int cell : thin) by_thickness.emplace_back(parts_.thickness(lowest_corner(cell)), cell);
  std::sort(by_thickness.begin(), by_thickness.end());
  parts_.refuse_as_thin("a body", lowest_corner(by_thickness[by_thickness.size() / 2].second));
}

/// Returns the volume of bodies in a cell.
double mesh_cutter::volume_of_body(int cell) const {
  if (kinds_[at(cell)] == kind::body) return mesh_.cell_volume();
  const auto cut = gas_.find(cell);
  return cut == gas_.end() ? 0.0 : mesh_.cell_volume() - cut->second.volume;
}

/// Throws input_error if a body has lost too much volume between the corners of cells. Checks the cells where
/// a part lies between two corners, and all cells of small bodies.
void mesh_cutter::check_lost_volume(const std::vector<int>& losing) const {
  std::vector<double> kept(bodies_.size(), 0.0), lost(bodies_.size(), 0.0), most(bodies_.size(), 0.0);
  std::vector<int> worst(bodies_.size(), -1);
  std::vector<std::vector<int>> cells(bodies_.size());
  for (int cell = 0; cell < mesh_.size(); ++cell)
    if (const double volume = volume_of_body(cell); volume > 0.0) {
      const std::size_t body = at(body_at(mesh_.centre(cell)));
      kept[body] += volume;
      if (cells[body].size() <= cells_of_small_body) cells[body].push_back(cell);
    }
  std::set<int> suspects(losing.begin(), losing.end());
  for (const auto& one : cells)
    if (one.size() <= cells_of_small_body) suspects.insert(one.begin(), one.end());
  for (const int cell : suspects) {
    const std::size_t body = at(body_at(mesh_.centre(cell)));
    const double here = parts_.closed_share(lowest_corner(cell)) * mesh_.cell_volume() - volume_of_body(cell);
    if (!(here > 0.0)) continue;
    lost[body] += here;
    if (here > most[body]) most[body] = here, worst[body] = cell;
  }
  for (std::size_t body = 0; body < bodies_.size(); ++body)
    if (lost[body] > largest_loss * (kept[body] + lost[body]))
      parts_.refuse_as_thin("a body", lowest_corner(worst[body]));
}

/// Whether no face of a cell is partly open.
bool mesh_cutter::is_whole(int cell) {
  for (int k = 0; k < mesh_.dimensions(); ++k)
    for (const bool upper : {false, true}) {
      const double share = share_of(cell, k, upper);
      if (share > 0.0 && share < 1.0) return false;
    }
  return true;
}

/// Whether a cell is like cells far from bodies: no face is partly open, and no face of the domain is closed.
bool mesh_cutter::is_like_whole(int cell) {
  if (!is_whole(cell)) return false;
  for (int k = 0; k < mesh_.dimensions(); ++k)
    for (const bool upper : {false, true})
      if (neighbour(cell, k, upper) < 0 && !(share_of(cell, k, upper) > 0.0)) return false;
  return true;
}

/// Checks the closed faces of a whole cell. If a cut cell lies behind such a face, the face becomes a wall of
/// this cell. Throws input_error if another whole cell lies behind it.
void mesh_cutter::check_closed_faces(int cell) {
  for (int k = 0; k < mesh_.dimensions(); ++k)
    for (const bool upper : {false, true}) {
      const int beside = neighbour(cell, k, upper);
      if (beside < 0 || !is_gas(beside) || share_of(cell, k, upper) > 0.0) continue;
      if (kinds_[at(beside)] == kind::whole) parts_.refuse_as_thin("a body", lowest_corner(cell));
      make_cut(cell);
      return;
    }
}

/// Turns a whole cell into a cut cell with its own walls.
void mesh_cutter::make_cut(int cell) {
  gas_of_cell whole{.volume = mesh_.cell_volume(), .centre = mesh_.centre(cell)};
  kinds_[at(cell)] = kind::cut;
  add_walls(cell, whole);
  gas_.emplace(cell, std::move(whole));
}

/// Measures the gas of a cell by the cones from the middle of the zeros of φ to the open faces. The cone to a
/// flat wall has no volume.
mesh_cutter::gas_of_cell mesh_cutter::measured(int cell) {
  const open_parts::corner corner = lowest_corner(cell);
  const position apex = parts_.middle_of_zeros(corner);
  const int dimensions = mesh_.dimensions();
  gas_of_cell made;
  position moment{};
  for (int k = 0; k < dimensions; ++k)
    for (const bool upper : {false, true}) {
      const auto [share, middle] = open_face_of(cell, k, upper);
      const double height = std::abs(middle[at(k)] - apex[at(k)]);
      const double volume = share * mesh_.face_area({k, upper}) * height / dimensions;
      made.volume += volume;
      for (std::size_t d = 0; d < 3; ++d)
        moment[d] += volume * (dimensions * middle[d] + apex[d]) / (dimensions + 1);
    }
  for (std::size_t d = 0; d < 3; ++d) made.centre[d] = moment[d] / made.volume;
  return made;
}

/// Adds a cell with corners in a body as a cut cell, unless all of it is gas.
void mesh_cutter::add_cut_cell(int cell) {
  gas_of_cell made = measured(cell);
  if (made.volume > all_gas * mesh_.cell_volume() && is_like_whole(cell)) return;
  kinds_[at(cell)] = kind::cut;
  add_walls(cell, made);
  gas_.emplace(cell, std::move(made));
}

/// Returns the zero of φ on the normal through a point, at most half a cell away. Returns the point itself if
/// there is no such zero.
position mesh_cutter::on_surface(position from, const std::array<double, 3>& normal) const {
  double reach = 0.0;
  for (int k = 0; k < mesh_.dimensions(); ++k) reach = std::max(reach, 0.5 * mesh_.spacing(k));
  const auto moved = [&](double by) {
    position x = from;
    for (std::size_t k = 0; k < 3; ++k) x[k] += by * normal[k];
    return x;
  };
  double open = reach, closed = -reach;
  if (!(phi_(moved(open)) > 0.0) || phi_(moved(closed)) > 0.0) return from;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (open + closed);
    (phi_(moved(middle)) > 0.0 ? open : closed) = middle;
  }
  return moved(0.5 * (open + closed));
}

/// Returns the loop of the zeros of φ on the edges of a cell. If the zeros form several loops, or a loop
/// without area, returns a flat piece at `middle` with the area and the normal of the wall.
std::vector<position> mesh_cutter::corners_of_wall(int cell, const position& middle,
                                                   const std::array<double, 3>& vector) {
  auto loops = parts_.wall_loops(lowest_corner(cell));
  const bool in_plane = mesh_.dimensions() == 2;
  if (loops.size() == 1 && loops.front().size() >= (in_plane ? 2U : 3U)) return loops.front();
  const auto at_offset = [&](const std::array<double, 3>& offset) {
    position x = middle;
    for (std::size_t k = 0; k < 3; ++k) x[k] += 0.5 * offset[k];
    return x;
  };
  if (in_plane) return {at_offset({vector[1], -vector[0], 0.0}), at_offset({-vector[1], vector[0], 0.0})};
  const double area = std::hypot(vector[0], vector[1], vector[2]), side = std::sqrt(area);
  std::array<double, 3> axis{}, first{}, second{};
  std::size_t least = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(vector[k]) < std::abs(vector[least])) least = k;
  axis[least] = 1.0;
  first = cross(vector, axis);
  const double length = std::hypot(first[0], first[1], first[2]);
  for (double& x : first) x *= side / length;
  second = cross(vector, first);
  for (double& x : second) x /= area;
  std::vector<position> square;
  for (const auto& [a, b] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
    square.push_back(at_offset(
        {a * first[0] + b * second[0], a * first[1] + b * second[1], a * first[2] + b * second[2]}));
  return square;
}

/// Returns the corners of a face of a cell that is a wall, or of its open part.
std::vector<position> mesh_cutter::corners_of_closed(int cell, int direction, bool upper, bool open_part) {
  open_parts::corner lowest = lowest_corner(cell);
  lowest[at(direction)] += upper ? 1 : 0;
  std::vector<position> corners =
      open_part ? parts_.corners_of_face(direction, lowest) : parts_.corners_of_square(direction, lowest);
  // In the plane the ends are in increasing order. On the way along a face normal to x the upper side is on
  // the right; along a face normal to y it is on the left.
  if (mesh_.dimensions() == 2 ? upper == (direction == 0) : upper)
    std::reverse(corners.begin(), corners.end());
  return corners;
}

/// Adds the pieces of wall of a cell: the rest of its partly open faces, closed faces, and faces of
/// solid boxes.
void mesh_cutter::add_walls(int cell, gas_of_cell& to) {
  const open_parts::corner corner = lowest_corner(cell);
  // A plane through corners of a cell may leave no face partly open, but cuts off half of the volume.
  const bool whole = is_whole(cell) && to.volume > all_gas * mesh_.cell_volume();
  const position centre = mesh_.centre(cell);
  // Vector area and moment of a closed surface about the centre are 0. Those of the wall are therefore
  // opposite to those of the open faces.
  std::array<double, 3> vector{}, moment{};
  double size = 0.0;
  for (int k = 0; k < mesh_.dimensions(); ++k)
    for (const bool upper : {false, true}) {
      const auto [share, middle] = open_face_of(cell, k, upper);
      const double area = mesh_.face_area({k, upper}), inwards = upper ? -1.0 : 1.0;
      const int beside = neighbour(cell, k, upper);
      std::array<double, 3> of_open{}, of_closed{};
      of_open[at(k)] = inwards * share * area;
      add_moment(middle, centre, of_open, -1.0, moment);
      if (beside >= 0 && kinds_[at(beside)] == kind::box && share > 0.0) {
        to.walls.push_back({mesh_.solid(beside), of_open, middle, corners_of_closed(cell, k, upper, true)});
      }
      vector[at(k)] -= of_open[at(k)];
      if (!whole || share > 0.0) continue;
      position x = centre;
      x[at(k)] -= 0.5 * inwards * mesh_.spacing(k);
      of_closed[at(k)] = inwards * area;
      const int solids = static_cast<int>(mesh_.solids().size());
      to.walls.push_back(
          {beside >= 0 && kinds_[at(beside)] == kind::box ? mesh_.solid(beside) : solids + body_at(x),
           of_closed, x, corners_of_closed(cell, k, upper, false)});
    }
  if (whole) return;
  for (const double x : vector) size += x * x;
  size = std::sqrt(size);
  if (!(size > 0.0)) return;
  std::array<double, 3> normal{};
  for (std::size_t k = 0; k < 3; ++k) normal[k] = vector[k] / size;
  const position x = on_surface(parts_.middle_of_zeros(corner), normal);
  add_moment(x, centre, vector, -1.0, moment);
  to.walls.push_back({static_cast<int>(mesh_.solids().size()) + body_at(x), vector, x,
                      corners_of_wall(cell, x, vector), moment});
}

/// Returns the open parts of the faces of a cell that is not solid.
std::vector<mesh_cutter::way_out> mesh_cutter::ways_out(int cell) {
  std::vector<way_out> found;
  for (int k = 0; k < mesh_.dimensions(); ++k)
    for (const bool upper : {false, true}) {
      const int beside = neighbour(cell, k, upper);
      if (beside >= 0 && !is_gas(beside)) continue;
      const auto [share, middle] = open_face_of(cell, k, upper);
      if (share > 0.0) found.push_back({k, upper, beside, share * mesh_.face_area({k, upper}), middle});
    }
  return found;
}

}  // namespace apsis
