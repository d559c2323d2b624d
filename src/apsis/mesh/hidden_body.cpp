#include <apsis/mesh/hidden_body.hpp>

#include <apsis/core/index.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/ranges.h>

namespace apsis {
namespace {

/// Returns whether some corner of a cell lies in the interior of a body.
bool has_corner_in(const grid& mesh, const outside_function& body) {
  std::array<int, 3> last{};
  for (int k = 0; k < mesh.dimensions(); ++k) last[at(k)] = mesh.cells(k);
  for (int i = 0; i <= last[0]; ++i)
    for (int j = 0; j <= last[1]; ++j)
      for (int l = 0; l <= last[2]; ++l) {
        position x{};
        const std::array<int, 3> corner = {i, j, l};
        for (int k = 0; k < mesh.dimensions(); ++k) x[at(k)] = mesh.edge(k, corner[at(k)]);
        if (body(x) < 0.0) return true;
      }
  return false;
}

/// Returns the least value of φ in the domain near the cell with the least value at its centre. Steps along
/// the axes are halved when none of them leads downwards.
double least_value(const grid& mesh, const outside_function& body) {
  position x = mesh.centre(0);
  double least = body(x);
  for (int cell = 1; cell < mesh.size(); ++cell)
    if (const double here = body(mesh.centre(cell)); here < least) {
      least = here;
      x = mesh.centre(cell);
    }
  constexpr double smallest = 1e-12;
  for (double step = 1.0; step > smallest;) {
    bool moved = false;
    for (int k = 0; k < mesh.dimensions(); ++k)
      for (const double sign : {-1.0, 1.0}) {
        position next = x;
        next[at(k)] = std::clamp(x[at(k)] + sign * step * mesh.spacing(k), mesh.edge(k, 0),
                                 mesh.edge(k, mesh.cells(k)));
        if (const double here = body(next); here < least) {
          least = here;
          x = next;
          moved = true;
        }
      }
    if (!moved) step *= 0.5;
  }
  return least;
}

}  // namespace

std::string why_hidden(const grid& mesh, const outside_function& body) {
  if (has_corner_in(mesh, body)) return "(it lies in another body or a solid box); remove it, or move it";
  const double depth = -least_value(mesh, body);
  if (!(depth > 0.0)) return "(it lies outside the domain); move it, or change space.domain";
  constexpr double cells_of_depth = 2.0;         // 4 cells across
  constexpr double without_rounding = 1 - 1e-9;  // the depth is known to 1e-12 cells
  std::vector<double> cells;
  for (int k = 0; k < mesh.dimensions(); ++k)
    cells.push_back(std::ceil(without_rounding * cells_of_depth * mesh.cells(k) * mesh.spacing(k) / depth));
  return fmt::format(
      "(it is about {:.3g} thick, and lies between the corners of cells); enlarge it, or give about "
      "space.cells = [{:.0f}]",
      2.0 * depth, fmt::join(cells, ", "));
}

}  // namespace apsis
