#include <apsis/body/internal/triangle_mesh.hpp>

#include <apsis/body/internal/vectors.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// A side of a triangle as an edge between vertices low < high.
struct edge_side {
  std::size_t low, high, triangle, side;
  bool rising;  ///< whether the side leads from low to high
};

std::vector<edge_side> sorted_sides(const triangle_mesh& mesh) {
  std::vector<edge_side> sides;
  sides.reserve(3 * mesh.corners.size());
  for (std::size_t t = 0; t < mesh.corners.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = mesh.corners[t][k], b = mesh.corners[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const edge_side& p, const edge_side& q) {
    return std::pair(p.low, p.high) < std::pair(q.low, q.high);
  });
  return sides;
}

/// The edges with a certain defect.
struct edge_defect {
  std::size_t count = 0;
  position at = {};  ///< the middle of the first edge
  void add(const position& a, const position& b) {
    if (count++ == 0) at = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
  }
  std::string place() const { return fmt::format("one at ({:.6g}, {:.6g}, {:.6g})", at[0], at[1], at[2]); }
  std::string edges(const char* verb_of_one, const char* verb_of_many) const {
    return count == 1 ? fmt::format("1 edge {}", verb_of_one)
                      : fmt::format("{} edges {}", count, verb_of_many);
  }
};

void drop_triangles_without_area(triangle_mesh& mesh) {
  std::erase_if(mesh.corners, [](const std::array<std::size_t, 3>& c) {
    return c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
  });
}

triangle_mesh merge_corners(const std::vector<space_triangle>& triangles) {
  const auto point = [&](std::size_t n) -> const position& { return triangles[n / 3][n % 3]; };
  std::vector<std::size_t> order(3 * triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t m, std::size_t n) { return point(m) < point(n); });
  triangle_mesh mesh;
  mesh.corners.resize(triangles.size());
  for (const std::size_t n : order) {
    if (mesh.vertices.empty() || mesh.vertices.back() != point(n)) mesh.vertices.push_back(point(n));
    mesh.corners[n / 3][n % 3] = mesh.vertices.size() - 1;
  }
  drop_triangles_without_area(mesh);
  return mesh;
}

/// The longest side of a triangle, and whether the triangle is so flat that its normal is undefined.
struct flatness {
  std::size_t longest_side = 0;
  bool is_flat = false;
};

flatness flatness_of(const triangle_mesh& mesh, std::size_t t) {
  // Coordinates of files have 24 bits. The height of other triangles is therefore more than 1e-8 of
  // their length.
  constexpr double least_height = 1e-12;
  flatness found;
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double length = vectors::length(vectors::difference(mesh.corner(t, k + 1), mesh.corner(t, k)));
    if (length > longest) {
      longest = length;
      found.longest_side = k;
    }
  }
  found.is_flat = vectors::length(mesh.area_vector(t)) <= least_height * longest * longest;
  return found;
}

/// Replaces flat triangles and their neighbours beyond the longest side by the two triangles of the other
/// diagonal. This leaves the surface unchanged. Returns true if there were flat triangles.
bool flip_flat_triangles(triangle_mesh& mesh) {
  std::vector<bool> is_changed(mesh.corners.size(), false);
  bool found = false;
  for (std::size_t t = 0; t < mesh.corners.size(); ++t) {
    const flatness flat = flatness_of(mesh, t);
    if (!flat.is_flat) continue;
    found = true;
    const std::size_t k = flat.longest_side, other = mesh.neighbours[t][k];
    if (is_changed[t] || is_changed[other]) continue;
    const std::size_t c = mesh.corners[t][k], a = mesh.corners[t][(k + 1) % 3],
                      b = mesh.corners[t][(k + 2) % 3];
    const auto& beyond = mesh.corners[other];
    const std::size_t d =
        *std::find_if(beyond.begin(), beyond.end(), [a, c](std::size_t v) { return v != a && v != c; });
    mesh.corners[t] = {a, b, d};
    mesh.corners[other] = {b, c, d};
    is_changed[t] = is_changed[other] = true;
  }
  return found;
}

}  // namespace

position triangle_mesh::area_vector(std::size_t t) const {
  return vectors::cross(vectors::difference(corner(t, 1), corner(t, 0)),
                        vectors::difference(corner(t, 2), corner(t, 0)));
}

void pair_sides(triangle_mesh& mesh) {
  mesh.neighbours.assign(mesh.corners.size(), {});
  const std::vector<edge_side> sides = sorted_sides(mesh);
  edge_defect alone, many, contrary;
  for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
    const edge_side& one = sides[first];
    for (end = first; end < sides.size() && sides[end].low == one.low && sides[end].high == one.high;) ++end;
    edge_defect* defect = nullptr;
    if (end - first == 1) defect = &alone;
    if (end - first > 2) defect = &many;
    if (end - first == 2) {
      const edge_side& other = sides[first + 1];
      mesh.neighbours[one.triangle][one.side] = other.triangle;
      mesh.neighbours[other.triangle][other.side] = one.triangle;
      if (one.rising == other.rising) defect = &contrary;
    }
    if (defect != nullptr) defect->add(mesh.vertices[one.low], mesh.vertices[one.high]);
  }
  if (many.count > 0)
    throw input_error(
        fmt::format("the surface branches ({} to more than two triangles, {}); separate its parts",
                    many.edges("belongs", "belong"), many.place()));
  if (alone.count > 0)
    throw input_error(fmt::format(
        "the surface is open ({} to one triangle alone, {}); close it in the program that wrote it",
        alone.edges("belongs", "belong"), alone.place()));
  if (contrary.count > 0)
    throw input_error(
        fmt::format("the surface has no orientation ({} the same direction in both triangles, {}); orient "
                    "neighbouring triangles alike",
                    contrary.edges("has", "have"), contrary.place()));
}

triangle_mesh make_closed_mesh(const std::vector<space_triangle>& triangles) {
  triangle_mesh mesh = merge_corners(triangles);
  if (mesh.corners.empty())
    throw input_error(fmt::format("the surface is empty ({} of its {} triangles have an area); give another",
                                  mesh.corners.size(), triangles.size()));
  pair_sides(mesh);
  // A chain of flat triangles needs one pass per triangle.
  constexpr int most_passes = 100;
  for (int pass = 0; flip_flat_triangles(mesh); ++pass) {
    if (pass == most_passes)
      throw input_error(
          "the surface has triangles with collinear corners (their edges cannot be flipped); "
          "give another triangulation");
    drop_triangles_without_area(mesh);
    pair_sides(mesh);
  }
  return mesh;
}

}  // namespace apsis
