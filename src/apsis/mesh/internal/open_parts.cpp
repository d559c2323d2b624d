#include <apsis/mesh/internal/open_parts.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

/// Shares of an edge below this number count as 0, and shares above 1 minus this number as 1: the
/// surface passes through the corner. If a surface touches an edge, its zero has only half of the digits
/// of other zeros.
constexpr double at_corner = 1e-6;
/// Number of bisections of an edge. The remaining interval is below the rounding of coordinates.
constexpr int halvings = 52;
/// Numbers of samples of φ, on lines for the thickness of a body and on the sides of a cell.
constexpr int samples_of_line = 64, samples_of_edge = 16;
/// A corner with |φ| below this share of its neighbours' values counts as a point of the surface. The sign of
/// its rounding error would differ between mirror images.
constexpr double on_surface = 1e-12;

open_parts::corner shifted(open_parts::corner from, int direction, int by = 1) {
  from[at(direction)] += by;
  return from;
}

}  // namespace

open_parts::open_parts(const grid& mesh, const outside_function& phi) : mesh_(mesh), phi_(phi) {
  if (mesh.dimensions() < 2)
    throw input_error("a body on a line (it needs two or three dimensions); use solid boxes");
  for (int k = 0; k < mesh.dimensions(); ++k) corners_[at(k)] = mesh.cells(k) + 1;
  values_.reserve(at(corners_[0]) * at(corners_[1]) * at(corners_[2]));
  for (int i = 0; i < corners_[0]; ++i)
    for (int j = 0; j < corners_[1]; ++j)
      for (int k = 0; k < corners_[2]; ++k) {
        const position x = point({i, j, k});
        const double value = phi_(x);
        if (!std::isfinite(value))
          throw input_error(fmt::format("a body is {} at ({:.6g}) (not a number); change its shape", value,
                                        fmt::join(x.begin(), x.begin() + mesh.dimensions(), ", ")));
        values_.push_back(value);
      }
  close_corners_on_surface();
}

/// Sets φ to 0 at corners where it is a rounding error.
void open_parts::close_corners_on_surface() {
  std::vector<long> touched;
  for (int i = 0; i < corners_[0]; ++i)
    for (int j = 0; j < corners_[1]; ++j)
      for (int k = 0; k < corners_[2]; ++k) {
        const corner here = {i, j, k};
        double around = 0.0;
        for (int d = 0; d < mesh_.dimensions(); ++d)
          for (const int by : {-1, 1})
            if (const corner next = shifted(here, d, by); next[at(d)] >= 0 && next[at(d)] < corners_[at(d)])
              around = std::max(around, std::abs(value(next)));
        if (std::abs(value(here)) < on_surface * around) touched.push_back(number(here));
      }
  for (const long one : touched) values_[static_cast<std::size_t>(one)] = 0.0;
}

long open_parts::number(const corner& at_) const {
  return (static_cast<long>(at_[0]) * corners_[1] + at_[1]) * corners_[2] + at_[2];
}

position open_parts::point(const corner& of) const {
  return point(of, {});
}

position open_parts::point(const corner& of, const std::array<double, 3>& shift) const {
  position x{};
  for (int k = 0; k < mesh_.dimensions(); ++k)
    x[at(k)] = mesh_.edge(k, of[at(k)]) + shift[at(k)] * mesh_.spacing(k);
  return x;
}

open_parts::state open_parts::of_cell(const corner& lowest) const {
  int open = 0, all = 0;
  const int depth = mesh_.dimensions() == 3 ? 2 : 1;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < depth; ++k, ++all)
        open += is_open({lowest[0] + i, lowest[1] + j, lowest[2] + k}) ? 1 : 0;
  return open == all ? state::open : open == 0 ? state::closed : state::cut;
}

/// Returns the zero of φ on an edge, as a share of the edge from its lower end.
double open_parts::zero_on_edge(int direction, const corner& lower) {
  const auto [found, is_new] = zeros_[at(direction)].try_emplace(number(lower), 0.0);
  if (is_new) found->second = find_zero(direction, lower);
  return found->second;
}

/// Bisects from the open end, so that mirrored edges have mirrored zeros. If the closed end is on the
/// surface, a part of the edge may lie in a wall, where φ is a rounding error. This part counts as closed.
double open_parts::find_zero(int direction, const corner& lower) const {
  const bool from_lower = is_open(lower);
  const corner upper = shifted(lower, direction);
  const double least = on_surface * value(from_lower ? lower : upper),
               rounding = std::abs(value(from_lower ? upper : lower)) < least ? least : 0.0;
  double open = 0.0, closed = 1.0;
  for (int k = 0; k < halvings; ++k) {
    const double middle = 0.5 * (open + closed);
    std::array<double, 3> shift{};
    shift[at(direction)] = from_lower ? middle : 1.0 - middle;
    (phi_(point(lower, shift)) > rounding ? open : closed) = middle;
  }
  double share = closed;
  if (share < at_corner) share = 0.0;
  if (share > 1.0 - at_corner) share = 1.0;
  return from_lower ? share : 1.0 - share;
}

open_parts::part open_parts::open_edge(int direction, const corner& lower) {
  const bool first = is_open(lower), last = is_open(shifted(lower, direction));
  double begin = 0.0, end = 1.0;
  if (!first && !last) end = 0.0;
  if (first && !last) end = zero_on_edge(direction, lower);
  if (!first && last) begin = zero_on_edge(direction, lower);
  std::array<double, 3> shift{};
  shift[at(direction)] = 0.5 * (begin + end);
  return {end - begin, point(lower, shift)};
}

/// Returns the polygon of the open corners of a square and the zeros on its sides.
open_parts::polygon open_parts::open_vertices(const plane& of, const corner& lowest) {
  constexpr std::array<std::array<int, 2>, 4> around = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  polygon made;
  const auto add = [&made](const vertex& one) { made.vertices[made.count++] = one; };
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& [a, b] = around[k];
    const auto& [c, d] = around[(k + 1) % 4];
    const corner here = shifted(shifted(lowest, of.first, a), of.second, b),
                 next = shifted(shifted(lowest, of.first, c), of.second, d);
    if (is_open(here)) add({{1.0 * a, 1.0 * b}, here, -1});
    if (is_open(here) == is_open(next)) continue;
    const int along = a != c ? of.first : of.second;
    const corner lower = std::min(here, next);
    const double zero = zero_on_edge(along, lower);
    add({a != c ? std::array{zero, 1.0 * b} : std::array{1.0 * a, zero}, lower, along});
  }
  return made;
}

open_parts::part open_parts::open_polygon(const plane& of, const corner& lowest) {
  const auto [vertices, count] = open_vertices(of, lowest);
  double area = 0.0, first = 0.0, second = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto &p = vertices[k].share, &q = vertices[(k + 1) % count].share;
    const double twice = p[0] * q[1] - q[0] * p[1];
    area += 0.5 * twice;
    first += twice * (p[0] + q[0]) / 6.0;
    second += twice * (p[1] + q[1]) / 6.0;
  }
  std::array<double, 3> shift{};
  constexpr double nothing = 1e-15;
  if (area > nothing) shift[at(of.first)] = first / area, shift[at(of.second)] = second / area;
  return {area > nothing ? area : 0.0, point(lowest, shift)};
}

open_parts::part open_parts::face(int direction, const corner& lowest) {
  if (mesh_.dimensions() == 2) return open_edge(1 - direction, lowest);
  return open_polygon({(direction + 1) % 3, (direction + 2) % 3}, lowest);
}

/// Returns the point of a vertex. A zero at a corner has the bits of the corner.
position open_parts::point_of(const vertex& of) {
  if (of.edge < 0) return point(of.lower);
  const double zero = zero_on_edge(of.edge, of.lower);
  if (zero == 0.0) return point(of.lower);
  if (zero == 1.0) return point(shifted(of.lower, of.edge));
  std::array<double, 3> shift{};
  shift[at(of.edge)] = zero;
  return point(of.lower, shift);
}

std::vector<position> open_parts::corners_of_face(int direction, const corner& lowest) {
  std::vector<position> corners;
  if (mesh_.dimensions() == 2) {
    const int along = 1 - direction;
    const corner last = shifted(lowest, along);
    for (const corner& end : {lowest, last})
      corners.push_back(point_of(is_open(end) ? vertex{{}, end, -1} : vertex{{}, lowest, along}));
    return corners;
  }
  const auto [vertices, count] = open_vertices({(direction + 1) % 3, (direction + 2) % 3}, lowest);
  for (std::size_t k = 0; k < count; ++k) corners.push_back(point_of(vertices[k]));
  return corners;
}

std::vector<position> open_parts::corners_of_square(int direction, const corner& lowest) const {
  if (mesh_.dimensions() == 2) return {point(lowest), point(shifted(lowest, 1 - direction))};
  const int first = (direction + 1) % 3, second = (direction + 2) % 3;
  const corner next = shifted(lowest, first);
  return {point(lowest), point(next), point(shifted(next, second)), point(shifted(lowest, second))};
}

/// Adds the sides of the open part of a square that cross the square. Each leads from the zero behind open
/// corners to the next zero.
void open_parts::add_wall_sides(const plane& of, const corner& lowest, bool reversed, zero_chain& chain) {
  const auto [vertices, count] = open_vertices(of, lowest);
  const auto key = [this](const vertex& one) { return edge_key{one.edge, number(one.lower)}; };
  for (std::size_t k = 0; k < count; ++k) {
    const vertex &from = vertices[k], &to = vertices[(k + 1) % count];
    if (from.edge < 0 || to.edge < 0) continue;
    const vertex &first = reversed ? to : from, &second = reversed ? from : to;
    chain.insert_or_assign(key(first), std::pair{first, key(second)});
  }
}

std::vector<std::vector<position>> open_parts::wall_loops(const corner& lowest) {
  zero_chain chain;
  if (mesh_.dimensions() == 2) {
    add_wall_sides({0, 1}, lowest, true, chain);
    std::vector<std::vector<position>> segments;
    for (const auto& [edge, side] : chain) {
      const auto& [direction, lower] = side.second;
      const corner end = {static_cast<int>(lower / corners_[2] / corners_[1]),
                          static_cast<int>(lower / corners_[2] % corners_[1]), 0};
      segments.push_back({point_of(side.first), point_of({{}, end, direction})});
    }
    return segments;
  }
  for (int normal = 0; normal < 3; ++normal)
    for (const bool upper : {false, true})
      add_wall_sides({(normal + 1) % 3, (normal + 2) % 3}, shifted(lowest, normal, upper ? 1 : 0), !upper,
                     chain);
  std::vector<std::vector<position>> loops;
  while (!chain.empty()) {
    std::vector<position> loop;
    for (auto next = chain.begin(); next != chain.end();) {
      const auto [zero, following] = next->second;
      const position x = point_of(zero);
      if (loop.empty() || x != loop.back()) loop.push_back(x);
      chain.erase(next);
      next = chain.find(following);
    }
    while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    loops.push_back(std::move(loop));
  }
  return loops;
}

position open_parts::middle_of_zeros(const corner& lowest) {
  position sum{};
  int count = 0;
  for (int direction = 0; direction < mesh_.dimensions(); ++direction) {
    const int other = (direction + 1) % mesh_.dimensions(), third = 3 - direction - other;
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < (mesh_.dimensions() == 3 ? 2 : 1); ++b) {
        const corner lower = shifted(shifted(lowest, other, a), third, b);
        if (is_open(lower) == is_open(shifted(lower, direction))) continue;
        std::array<double, 3> shift{};
        shift[at(direction)] = zero_on_edge(direction, lower);
        const position x = point(lower, shift);
        for (std::size_t k = 0; k < 3; ++k) sum[k] += x[k];
        ++count;
      }
  }
  for (double& x : sum) x /= std::max(count, 1);
  return sum;
}

/// Whether the open corners of a cell are connected by edges, and the closed ones too.
bool open_parts::corners_are_connected(const corner& lowest) const {
  const int count = 1 << mesh_.dimensions();
  const auto of = [&](int bits) {
    return is_open({lowest[0] + (bits & 1), lowest[1] + (bits >> 1 & 1), lowest[2] + (bits >> 2)});
  };
  for (const bool open : {true, false}) {
    unsigned members = 0, reached = 0;
    for (int c = 0; c < count; ++c)
      if (of(c) == open) members |= 1U << c;
    reached = members & (~members + 1U);  // the lowest member
    for (int round = 0; round < count; ++round)
      for (int c = 0; c < count; ++c)
        for (int k = 0; k < mesh_.dimensions(); ++k)
          if ((reached >> c & 1U) != 0) reached |= (1U << (c ^ (1 << k))) & members;
    if (reached != members) return false;
  }
  return true;
}

double open_parts::thickness(const corner& lowest) const {
  double least = 1.0;
  const auto along = [&](const std::array<double, 3>& from, const std::array<double, 3>& to) {
    int last_change = -1;
    bool before = false;
    for (int k = 0; k <= samples_of_line; ++k) {
      std::array<double, 3> shift{};
      for (std::size_t d = 0; d < 3; ++d) shift[d] = from[d] + (to[d] - from[d]) * k / samples_of_line;
      const bool open = phi_(point(lowest, shift)) > 0.0;
      if (k > 0 && open != before) {
        if (last_change >= 0)
          least = std::min(least, std::max(k - last_change, 1) / static_cast<double>(samples_of_line));
        last_change = k;
      }
      before = open;
    }
  };
  const int depth = mesh_.dimensions() == 3 ? 3 : 1;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < depth; ++b)
      for (int k = 0; k < mesh_.dimensions(); ++k) {
        std::array<double, 3> from{}, to{};
        const int other = (k + 1) % mesh_.dimensions(), third = 3 - k - other;
        from[at(other)] = to[at(other)] = 0.5 * a;
        from[at(third)] = to[at(third)] = 0.5 * b;
        to[at(k)] = 1.0;
        along(from, to);
      }
  return least;
}

/// Counts the stretches of a side of a square that reach neither of its ends. A strip through the square
/// crosses two sides in such stretches. A tip that ends in the square crosses one.
void open_parts::count_stretches(const corner& lowest, const std::array<double, 3>& from, int direction,
                                 stretches& found) const {
  std::array<double, 3> shift = from;
  bool before = false, has_changed = false;
  for (int k = 0; k <= samples_of_edge; ++k) {
    shift[at(direction)] = static_cast<double>(k) / samples_of_edge;
    const bool open = phi_(point(lowest, shift)) > 0.0;
    if (k > 0 && open != before) {
      if (has_changed) ++(before ? found.gaps : found.bodies);
      has_changed = true;
    }
    before = open;
  }
}

open_parts::thin_cell open_parts::thin_in_square(const corner& lowest, const plane& of,
                                                 const std::array<double, 3>& from) const {
  stretches sides;
  for (const auto& [along, across] : {std::pair{of.first, of.second}, {of.second, of.first}})
    for (const double side : {0.0, 1.0}) {
      std::array<double, 3> begin = from;
      begin[at(across)] += side;
      count_stretches(lowest, begin, along, sides);
    }
  const thin_part found = sides.gaps > 1     ? thin_part::gap
                          : sides.bodies > 1 ? thin_part::body
                                             : thin_part::none;
  return {found, sides.bodies > 0};
}

/// Returns the gap or the body in the middle of a cell whose corners and middles of faces are on the other
/// side of the surface.
open_parts::thin_part open_parts::island_in(const corner& lowest) const {
  const state corners = of_cell(lowest);
  if (corners == state::cut) return thin_part::none;
  const bool deep = mesh_.dimensions() == 3;
  const auto open_at = [&](double i, double j, double k) {
    return phi_(point(lowest, {i, j, deep ? k : 0.0})) > 0.0;
  };
  const bool inside = open_at(0.5, 0.5, 0.5);
  if (inside == (corners == state::open)) return thin_part::none;
  // The tip of a body would reach the middle through a face.
  for (const double side : {0.0, 1.0})
    if (open_at(side, 0.5, 0.5) == inside || open_at(0.5, side, 0.5) == inside ||
        (deep && open_at(0.5, 0.5, side) == inside))
      return thin_part::none;
  return inside ? thin_part::gap : thin_part::body;
}

/// Returns the gap between closed corners, or the body between open corners, that no edges of the cell
/// connect. The middle of a face whose corners alternate decides between the two. Without such a face the
/// middle of the cell decides.
open_parts::thin_part open_parts::between_corners(const corner& lowest) const {
  if (corners_are_connected(lowest)) return thin_part::none;
  const bool deep = mesh_.dimensions() == 3;
  thin_part found = thin_part::none;
  for (int normal = deep ? 0 : 2; normal < 3; ++normal)
    for (int side = 0; side < (deep ? 2 : 1); ++side) {
      const int first = (normal + 1) % 3, second = (normal + 2) % 3;
      const corner a = shifted(lowest, normal, side), b = shifted(a, first), c = shifted(b, second),
                   d = shifted(a, second);
      if (is_open(a) != is_open(c) || is_open(b) != is_open(d) || is_open(a) == is_open(b)) continue;
      std::array<double, 3> middle{};
      middle[at(first)] = middle[at(second)] = 0.5;
      if (phi_(point(a, middle)) > 0.0) return thin_part::gap;
      found = thin_part::body;
    }
  if (found != thin_part::none) return found;
  return phi_(point(lowest, {0.5, 0.5, deep ? 0.5 : 0.0})) > 0.0 ? thin_part::gap : thin_part::body;
}

open_parts::thin_cell open_parts::thin_in(const corner& lowest) const {
  const bool deep = mesh_.dimensions() == 3;
  for (const thin_part one : {island_in(lowest), between_corners(lowest)})
    if (one != thin_part::none) return {one, one == thin_part::body};
  if (!deep) return thin_in_square(lowest, {0, 1}, {});
  // A plate leaves strips in at least two faces. The edge of a body that ends in the cell leaves a strip in
  // one face.
  int gaps = 0, strips = 0;
  thin_cell found;
  for (int normal = 0; normal < 3; ++normal)
    for (const double side : {0.0, 1.0}) {
      std::array<double, 3> from{};
      from[at(normal)] = side;
      const thin_cell one = thin_in_square(lowest, {(normal + 1) % 3, (normal + 2) % 3}, from);
      gaps += one.part == thin_part::gap ? 1 : 0;
      strips += one.part == thin_part::body ? 1 : 0;
      found.loses = found.loses || one.loses;
    }
  found.part = gaps > 1 ? thin_part::gap : strips > 1 ? thin_part::body : thin_part::none;
  return found;
}

double open_parts::closed_share(const corner& lowest) const {
  constexpr int samples = 8;
  const int depth = mesh_.dimensions() == 3 ? samples : 1;
  const auto middle = [](int k) { return (k + 0.5) / samples; };
  int closed = 0;
  for (int i = 0; i < samples; ++i)
    for (int j = 0; j < samples; ++j)
      for (int k = 0; k < depth; ++k)
        closed += phi_(point(lowest, {middle(i), middle(j), depth > 1 ? middle(k) : 0.0})) > 0.0 ? 0 : 1;
  return static_cast<double>(closed) / (samples * samples * depth);
}

bool open_parts::may_be_thin(const corner& lowest) const {
  if (of_cell(lowest) == state::cut) return true;
  const bool deep = mesh_.dimensions() == 3;
  const double middle = phi_(point(lowest, {0.5, 0.5, deep ? 0.5 : 0.0}));
  double change = 0.0;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < (deep ? 2 : 1); ++k)
        change = std::max(change, std::abs(value({lowest[0] + i, lowest[1] + j, lowest[2] + k}) - middle));
  // True unless the surface is far from the cell.
  return !(std::abs(middle) > 3.0 * change);
}

void open_parts::refuse_as_thin(const std::string& something, const corner& lowest) const {
  // Cells half as long as the stretch have a corner in it, wherever it lies.
  const double needed = 2.0 / std::min(thickness(lowest), 1.0);
  std::array<long, 3> cells{};
  for (int k = 0; k < mesh_.dimensions(); ++k)
    cells[at(k)] = static_cast<long>(std::ceil(needed * mesh_.cells(k)));
  const position x = point(lowest, {0.5, 0.5, mesh_.dimensions() == 3 ? 0.5 : 0.0});
  throw input_error(fmt::format(
      "{} is thinner than a cell near ({:.6g}) (the surface passes between the corners of cells); give about "
      "space.cells = [{}]",
      something, fmt::join(x.begin(), x.begin() + mesh_.dimensions(), ", "),
      fmt::join(cells.begin(), cells.begin() + mesh_.dimensions(), ", ")));
}

}  // namespace apsis
