#include <apsis/body/triangle_surface.hpp>

#include <apsis/body/internal/triangle_mesh.hpp>
#include <apsis/body/internal/vectors.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>

namespace apsis {
namespace {

using tree_point = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
using tree_box = boost::geometry::model::box<tree_point>;
using tree_entry = std::pair<tree_box, std::size_t>;
using triangle_tree = boost::geometry::index::rtree<tree_entry, boost::geometry::index::rstar<16>>;

tree_point to_tree(const position& x) {
  return {x[0], x[1], x[2]};
}

double squared_distance_of(const tree_box& box, const position& x) {
  const tree_point &low = box.min_corner(), &high = box.max_corner();
  const position past = {std::max({low.get<0>() - x[0], x[0] - high.get<0>(), 0.0}),
                         std::max({low.get<1>() - x[1], x[1] - high.get<1>(), 0.0}),
                         std::max({low.get<2>() - x[2], x[2] - high.get<2>(), 0.0})};
  return vectors::dot(past, past);
}

tree_box box_of(const triangle_mesh& mesh, std::size_t t) {
  position low = mesh.corner(t, 0), high = low;
  for (std::size_t n = 1; n < 3; ++n)
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], mesh.corner(t, n)[k]);
      high[k] = std::max(high[k], mesh.corner(t, n)[k]);
    }
  return {to_tree(low), to_tree(high)};
}

/// Normals of a triangle and pseudonormals of its sides and corners.
struct triangle_normals {
  position face = {};                    ///< of length 1
  std::array<position, 3> sides = {};    ///< sum of the normals of both triangles
  std::array<position, 3> corners = {};  ///< sum of the normals of all triangles, weighted with their angles
};

std::vector<triangle_normals> compute_normals(const triangle_mesh& mesh) {
  std::vector<triangle_normals> normals(mesh.corners.size());
  std::vector<position> at_vertices(mesh.vertices.size(), position{});
  for (std::size_t t = 0; t < normals.size(); ++t) {
    const position area = mesh.area_vector(t);
    normals[t].face = vectors::add_multiple({}, 1.0 / vectors::length(area), area);
    for (std::size_t k = 0; k < 3; ++k) {
      const position u = vectors::difference(mesh.corner(t, k + 1), mesh.corner(t, k)),
                     v = vectors::difference(mesh.corner(t, k + 2), mesh.corner(t, k));
      const double angle = std::atan2(vectors::length(vectors::cross(u, v)), vectors::dot(u, v));
      position& sum = at_vertices[mesh.corners[t][k]];
      sum = vectors::add_multiple(sum, angle, normals[t].face);
    }
  }
  for (std::size_t t = 0; t < normals.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      normals[t].sides[k] = vectors::add_multiple(normals[t].face, 1.0, normals[mesh.neighbours[t][k]].face);
      normals[t].corners[k] = at_vertices[mesh.corners[t][k]];
    }
  return normals;
}

/// The squared distance of a point from a triangle, and a number whose sign is that of the side of the point.
struct triangle_distance {
  double squared = std::numeric_limits<double>::infinity();
  double side = 1.0;
};

triangle_distance distance_of_side(const triangle_mesh& mesh, const triangle_normals& normals, std::size_t t,
                                   std::size_t k, const position& x) {
  const position &a = mesh.corner(t, k), &b = mesh.corner(t, k + 1);
  const position along = vectors::difference(b, a), from_a = vectors::difference(x, a);
  const double part = vectors::dot(along, from_a), whole = vectors::dot(along, along);
  if (part <= 0.0) return {vectors::dot(from_a, from_a), vectors::dot(from_a, normals.corners[k])};
  if (part >= whole) {
    const position from_b = vectors::difference(x, b);
    return {vectors::dot(from_b, from_b), vectors::dot(from_b, normals.corners[(k + 1) % 3])};
  }
  const position across = vectors::add_multiple(from_a, -part / whole, along);
  return {vectors::dot(across, across), vectors::dot(across, normals.sides[k])};
}

triangle_distance distance_of_triangle(const triangle_mesh& mesh, const triangle_normals& normals,
                                       std::size_t t, const position& x) {
  bool is_above = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const position along = vectors::difference(mesh.corner(t, k + 1), mesh.corner(t, k));
    const position to_x = vectors::difference(x, mesh.corner(t, k));
    is_above = is_above && vectors::dot(vectors::cross(along, to_x), normals.face) >= 0.0;
  }
  if (is_above) {
    const double height = vectors::dot(normals.face, vectors::difference(x, mesh.corner(t, 0)));
    return {height * height, height};
  }
  triangle_distance nearest;
  for (std::size_t k = 0; k < 3; ++k) {
    const triangle_distance one = distance_of_side(mesh, normals, t, k, x);
    if (one.squared < nearest.squared) nearest = one;
  }
  return nearest;
}

}  // namespace

/// The mesh with its normals, and boxes of triangles for the search of the nearest one.
struct triangle_surface::parts {
  triangle_mesh mesh;
  std::vector<triangle_normals> normals;
  triangle_tree tree;
  double volume = 0.0, area = 0.0;
  int shells = 0;
};

triangle_surface::triangle_surface(const std::vector<space_triangle>& triangles) {
  auto made = std::make_unique<parts>();
  made->mesh = make_closed_mesh(triangles);
  const auto shells = compute_shells(made->mesh);
  orient_shells(made->mesh, shells);
  made->shells = static_cast<int>(shells.size());
  for (const auto& shell : shells) made->volume += compute_volume(made->mesh, shell);
  made->normals = compute_normals(made->mesh);
  std::vector<tree_entry> boxes;
  for (std::size_t t = 0; t < made->mesh.corners.size(); ++t) {
    made->area += 0.5 * vectors::length(made->mesh.area_vector(t));
    boxes.emplace_back(box_of(made->mesh, t), t);
  }
  made->tree = triangle_tree(boxes);  // balanced, unlike a tree of single insertions
  parts_ = std::move(made);
}

triangle_surface::~triangle_surface() = default;
triangle_surface::triangle_surface(triangle_surface&&) noexcept = default;
triangle_surface& triangle_surface::operator=(triangle_surface&&) noexcept = default;

double triangle_surface::signed_distance(const position& x) const {
  const triangle_mesh& mesh = parts_->mesh;
  const triangle_tree& tree = parts_->tree;
  triangle_distance nearest;
  // The nearest triangle need not have the nearest box. Boxes come in the order of their distance.
  const auto all = boost::geometry::index::nearest(to_tree(x), static_cast<unsigned>(mesh.corners.size()));
  for (auto box = tree.qbegin(all); box != tree.qend(); ++box) {
    if (squared_distance_of(box->first, x) > nearest.squared) break;
    const triangle_distance one = distance_of_triangle(mesh, parts_->normals[box->second], box->second, x);
    if (one.squared < nearest.squared) nearest = one;
  }
  return nearest.side > 0.0 ? std::sqrt(nearest.squared) : -std::sqrt(nearest.squared);
}

double triangle_surface::volume() const {
  return parts_->volume;
}
double triangle_surface::area() const {
  return parts_->area;
}
int triangle_surface::triangles() const {
  return static_cast<int>(parts_->normals.size());
}
int triangle_surface::vertices() const {
  return static_cast<int>(parts_->mesh.vertices.size());
}
int triangle_surface::shells() const {
  return parts_->shells;
}

}  // namespace apsis
