// Connected parts of a surface: volumes and orientation.
#include <apsis/body/internal/triangle_mesh.hpp>
#include <apsis/body/internal/vectors.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// The smallest box around a shell.
struct shell_bounds {
  position low, high;
  bool contain(const position& x) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (x[k] < low[k] || x[k] > high[k]) return false;
    return true;
  }
};

shell_bounds bounds_of(const triangle_mesh& mesh, const std::vector<std::size_t>& shell) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  shell_bounds box = {{infinite, infinite, infinite}, {-infinite, -infinite, -infinite}};
  for (const std::size_t t : shell)
    for (std::size_t n = 0; n < 3; ++n)
      for (std::size_t k = 0; k < 3; ++k) {
        box.low[k] = std::min(box.low[k], mesh.corner(t, n)[k]);
        box.high[k] = std::max(box.high[k], mesh.corner(t, n)[k]);
      }
  return box;
}

/// Returns the signed solid angle of a triangle seen from x (Van Oosterom, Strackee, IEEE Trans. Biomed. Eng.
/// 30, 1983).
double solid_angle(const triangle_mesh& mesh, std::size_t t, const position& x) {
  const position a = vectors::difference(mesh.corner(t, 0), x), b = vectors::difference(mesh.corner(t, 1), x),
                 c = vectors::difference(mesh.corner(t, 2), x);
  const double p = vectors::length(a), q = vectors::length(b), r = vectors::length(c);
  return 2.0 *
         std::atan2(vectors::dot(a, vectors::cross(b, c)),
                    p * q * r + r * vectors::dot(a, b) + p * vectors::dot(b, c) + q * vectors::dot(c, a));
}

double area_of(const triangle_mesh& mesh, const std::vector<std::size_t>& shell) {
  double sum = 0.0;
  for (const std::size_t t : shell) sum += 0.5 * vectors::length(mesh.area_vector(t));
  return sum;
}

/// Checks that a shell with positive volume is outside the body of the other shells, and a shell with
/// negative volume inside it. The winding number of the other shells at a point of the shell must be 0 or
/// 1, respectively.
void check_nesting(const triangle_mesh& mesh, const std::vector<std::vector<std::size_t>>& shells,
                   const std::vector<double>& volumes) {
  std::vector<shell_bounds> bounds;
  for (const auto& shell : shells) bounds.push_back(bounds_of(mesh, shell));
  for (std::size_t s = 0; s < shells.size(); ++s) {
    const position& x = mesh.corner(shells[s].front(), 0);
    double winding = 0.0;
    for (std::size_t other = 0; other < shells.size(); ++other)
      if (other != s && bounds[other].contain(x))
        for (const std::size_t t : shells[other])
          winding += solid_angle(mesh, t, x) / (4.0 * std::numbers::pi);
    // Winding numbers are fractions where shells touch each other.
    if (volumes[s] > 0.0 ? winding < 0.75 : winding > 0.25) continue;
    throw input_error(fmt::format(
        "a part of the surface has the wrong orientation ({} with the corner ({:.6g}, {:.6g}, {:.6g})); {}",
        volumes[s] > 0.0 ? "the part inside the body" : "the cavity outside the body", x[0], x[1], x[2],
        "reverse its triangles or remove it"));
  }
}

}  // namespace

std::vector<std::vector<std::size_t>> compute_shells(const triangle_mesh& mesh) {
  std::vector<std::vector<std::size_t>> shells;
  std::vector<bool> is_found(mesh.corners.size(), false);
  for (std::size_t start = 0; start < mesh.corners.size(); ++start) {
    if (is_found[start]) continue;
    is_found[start] = true;
    std::vector<std::size_t> shell = {start};
    for (std::size_t n = 0; n < shell.size(); ++n)
      for (const std::size_t next : mesh.neighbours[shell[n]])
        if (!is_found[next]) {
          is_found[next] = true;
          shell.push_back(next);
        }
    shells.push_back(std::move(shell));
  }
  return shells;
}

double compute_volume(const triangle_mesh& mesh, const std::vector<std::size_t>& shell) {
  // Coordinates relative to a point of the shell avoid cancellation far from the origin.
  const position& origin = mesh.corner(shell.front(), 0);
  double sum = 0.0;
  for (const std::size_t t : shell)
    sum += vectors::dot(vectors::difference(mesh.corner(t, 0), origin), mesh.area_vector(t));
  return sum / 6.0;
}

void orient_shells(triangle_mesh& mesh, const std::vector<std::vector<std::size_t>>& shells) {
  // Rounding errors of the volume are some 1e-16 of the power 3/2 of the area.
  constexpr double least_volume = 1e-12;
  std::vector<double> volumes;
  double total = 0.0;
  for (const auto& shell : shells) {
    volumes.push_back(compute_volume(mesh, shell));
    total += volumes.back();
    if (std::abs(volumes.back()) <= least_volume * std::pow(area_of(mesh, shell), 1.5)) {
      const position& x = mesh.corner(shell.front(), 0);
      throw input_error(fmt::format(
          "a part of the surface encloses no volume (it has the corner ({:.6g}, {:.6g}, {:.6g})); remove it",
          x[0], x[1], x[2]));
    }
  }
  if (total < 0.0) {
    for (auto& corners : mesh.corners) std::swap(corners[1], corners[2]);
    for (double& volume : volumes) volume = -volume;
    pair_sides(mesh);
  }
  if (shells.size() > 1) check_nesting(mesh, shells, volumes);
}

}  // namespace apsis
