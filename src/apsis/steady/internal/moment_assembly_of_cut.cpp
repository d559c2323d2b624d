// The part of J that belongs to cut cells.
#include <apsis/core/index.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/semidiscrete/cut_gradient.hpp>
#include <apsis/steady/internal/flux_derivative.hpp>
#include <apsis/steady/internal/moment_assembly.hpp>

namespace apsis {

void moment_assembly::add_cut_cells(std::span<const double> blocks, block_matrix& to) const {
  for (const group_of_cut& of : cut_.groups()) {
    add_walls(blocks, of, to);
    // A face between two groups is among the ways of both.
    for (const way_out_of_cut& way : of.ways)
      if (way.other >= 0 && (cut_.group_of(way.other) < 0 || of.cell < way.other))
        add_face_of_cut(blocks, way.face, to);
  }
}

/// Returns the weights of cells in the value at a vector from the centroid of a group. The gas of a group
/// varies linearly, except in first order.
std::vector<std::pair<int, double>> moment_assembly::line_of_cut(int group,
                                                                 const std::array<double, 3>& to) const {
  const int here = cut_.groups()[at(group)].cell;
  std::vector<std::pair<int, double>> found = {{here, 1.0}};
  if (first_order_) return found;
  for (const auto& [cell, weight] : gradient_weights(*space_.mesh().cut(), group)) {
    double factor = 0.0;
    for (std::size_t k = 0; k < 3; ++k) factor += weight[k] * to[k];
    found.front().second -= factor;
    found.emplace_back(cell, factor);
  }
  return found;
}

/// Adds the upwind flux of linear functions through an open face, and the flux of the
/// deviation from equilibrium.
void moment_assembly::add_face_of_cut(std::span<const double> blocks, int number, block_matrix& to) const {
  const open_face& one = space_.mesh().cut()->faces()[at(number)];
  const int d = one.direction;
  struct side {
    int cell;
    double per_length;
  };
  flux_derivative flux(layout_.square());
  // Adds the values that leave a side.
  const auto add_side = [&](int cell, bool is_below, const std::array<double, 3>& from_centre) -> side {
    const std::size_t place = layout_.transport(d, is_below);
    const int group = cut_.group_of(cell);
    if (group < 0) {
      for (const auto& [of, weight] : edge_of(links_, d, is_below, cell, first_order_))
        flux.add(of, weight, block_of(blocks, of, place));
      return {cell, 1.0 / space_.mesh().spacing(d)};
    }
    for (const auto& [of, weight] : line_of_cut(group, from_centre))
      flux.add(of, weight, block_of(blocks, of, place));
    const double volume = space_.mesh().cut()->groups()[at(group)].volume;
    return {cut_.first_of(cell), one.area / volume};
  };
  const side below = add_side(one.below, true, one.from_below),
             above = add_side(one.above, false, one.from_above);
  const double apart = one.from_below[at(d)] - one.from_above[at(d)];
  for (const int of_spread : {below.cell, above.cell}) {
    flux.add(above.cell, -0.5 / apart, block_of(blocks, of_spread, layout_.deviation(d)));
    flux.add(below.cell, 0.5 / apart, block_of(blocks, of_spread, layout_.deviation(d)));
    if (layout_.turns && d == layout_.radial())
      flux.add(of_spread, 0.5, block_of(blocks, of_spread, layout_.turned_then_moved()));
  }
  for (const auto& [of, block] : flux) {
    add_block(number_[at(below.cell)], number_[at(of)], below.per_length, block, to);
    add_block(number_[at(above.cell)], number_[at(of)], -above.per_length, block, to);
  }
}

/// Adds the fluxes at walls and ends, with values of the linear function of the group there.
void moment_assembly::add_walls(std::span<const double> blocks, const group_of_cut& of,
                                block_matrix& to) const {
  const int row = number_[at(of.cell)];
  add_block(row, row, 1.0, block_of(blocks, of.cell, layout_.walls(0)), to);
  if (first_order_) return;
  for (int k = 0; k < layout_.directions; ++k) {
    const double* block = block_of(blocks, of.cell, layout_.walls(k + 1));
    for (const auto& [cell, weight] : gradient_weights(*space_.mesh().cut(), cut_.group_of(of.cell))) {
      add_block(row, number_[at(cell)], weight[at(k)], block, to);
      add_block(row, row, -weight[at(k)], block, to);
    }
  }
}

}  // namespace apsis
