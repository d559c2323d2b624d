#include <apsis/steady/internal/moment_assembly.hpp>

#include <apsis/core/index.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/model/gas_model.hpp>
#include <apsis/semidiscrete/cut_gradient.hpp>
#include <apsis/steady/dissection.hpp>
#include <apsis/steady/internal/flux_derivative.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace apsis {
namespace {

/// Fluxes along a direction depend on two cells on each side of a cell.
constexpr std::size_t blocks_of_row = 5;

dissected_mesh dissected(const domain& space, bool first_order) {
  std::array<bool, 3> periodic{};
  for (int d = 0; d < space.mesh().dimensions(); ++d) periodic[at(d)] = space.periodic(d);
  return dissect(space.mesh(), periodic, first_order ? 1 : 2);
}

}  // namespace

moment_assembly::moment_assembly(const relaxation_model& equation, const domain& space,
                                 const inside_domain& acts, const jacobian_layout& layout, bool first_order)
    : equation_(equation),
      space_(space),
      acts_(acts),
      layout_(layout),
      links_(space),
      cut_(space),
      first_order_(first_order),
      count_(layout.moments),
      number_(at(space.mesh().size()), -1),
      mesh_(number_cells()) {}

moment_mesh moment_assembly::number_cells() {
  const grid& mesh = space_.mesh();
  dissected_mesh order = dissected(space_, first_order_);
  int number = 0;
  for (const int cell : order.cells) number_[at(cell)] = number++;
  moment_mesh found{.directions = mesh.dimensions(),
                    .moments = count_,
                    .cells = static_cast<int>(links_.cells().size()),
                    .parts = std::move(order.parts),
                    .extent = 0.0,
                    .spacing = mesh.spacing(0),
                    .first_order = first_order_};
  found.volumes.resize(links_.cells().size());
  for (const int cell : links_.cells()) found.volumes[at(number_[at(cell)])] = links_.volume(cell);
  for (int d = 0; d < mesh.dimensions(); ++d) {
    found.lines[at(d)] = lines_along(links_, d, number_);
    found.extent = std::max(found.extent, mesh.spacing(d) * mesh.cells(d));
    found.spacing = std::min(found.spacing, mesh.spacing(d));
  }
  return found;
}

moment_equations moment_assembly::assemble(std::span<const double> blocks, double pseudo_rate) const {
  moment_equations all(mesh_);
  for (int d = 0; d < layout_.directions; ++d) add_faces(blocks, d, all.along[at(d)]);
  add_cut_cells(blocks, all.inside);
  add_forces(all.inside);
  if (layout_.turns) add_rotation(blocks, all.inside);
  for (const int cell : links_.cells())
    if (layout_.source)
      add_block(number_[at(cell)], number_[at(cell)], -1.0, block_of(blocks, cell, layout_.of_source()),
                all.inside);
  find_conserved(all);
  if (pseudo_rate > 0.0)
    for (int k = 0; k < mesh_.unknowns(); ++k) all.inside.entry(k, k) += pseudo_rate;
  add_scales(blocks, all);
  return all;
}

void moment_assembly::add_block(int row, int column, double factor, const double* block,
                                block_matrix& to) const {
  double* sum = to.block(row, column);
  for (int k = 0; k < count_ * count_; ++k) sum[k] += factor * block[k];
}

/// Adds half-range sums of |v| and of v², averaged over the directions.
void moment_assembly::add_scales(std::span<const double> blocks, moment_equations& all) const {
  const std::size_t square = layout_.square();
  all.flights.assign(at(mesh_.cells) * square, 0.0);
  all.spreads = all.flights;
  const double share = 1.0 / layout_.directions;
  for (const int cell : links_.cells())
    for (int d = 0; d < layout_.directions; ++d) {
      const double *up = block_of(blocks, cell, layout_.transport(d, true)),
                   *down = block_of(blocks, cell, layout_.transport(d, false)),
                   *deviation = block_of(blocks, cell, layout_.deviation(d));
      const std::size_t first = at(number_[at(cell)]) * square;
      for (std::size_t k = 0; k < square; ++k) {
        all.flights[first + k] += share * (up[k] - down[k]);
        all.spreads[first + k] += share * deviation[k];
      }
    }
}

void moment_assembly::add_faces(std::span<const double> blocks, int direction, block_matrix& to) const {
  const double per_length = 1.0 / space_.mesh().spacing(direction);
  to.reserve(blocks_of_row * at(mesh_.cells));
  const std::size_t up = layout_.transport(direction, true), down = layout_.transport(direction, false),
                    deviation = layout_.deviation(direction);
  flux_derivative flux(layout_.square());
  // Adds the flux towards larger coordinates through the face between two cells, one of
  // them possibly missing.
  const auto add_flux = [&](int below, int above) {
    for (const auto& [of, block] : flux) {
      if (below >= 0) add_block(number_[at(below)], number_[at(of)], per_length, block, to);
      if (above >= 0) add_block(number_[at(above)], number_[at(of)], -per_length, block, to);
    }
    flux.clear();
  };
  for (const int cell : links_.cells()) {
    const int above = links_.next_or_image(direction, true, cell);
    if (above < 0) continue;
    for (const auto& [of, weight] : edge_of(links_, direction, true, cell, first_order_))
      flux.add(of, weight, block_of(blocks, of, up));
    for (const auto& [of, weight] : edge_of(links_, direction, false, above, first_order_))
      flux.add(of, weight, block_of(blocks, of, down));
    for (const int of_spread : {cell, above}) {
      flux.add(above, -0.5 * per_length, block_of(blocks, of_spread, deviation));
      flux.add(cell, 0.5 * per_length, block_of(blocks, of_spread, deviation));
      if (layout_.turns && direction == layout_.radial())
        flux.add(of_spread, 0.5, block_of(blocks, of_spread, layout_.turned_then_moved()));
    }
    add_flux(cell, above);
  }
  for (const gas_end_of_segment& end : links_.ends()) {
    if (end.where.direction != direction) continue;
    const bool upper = end.where.upper;
    const int cell = end.cells[0];
    for (const auto& [of, weight] : edge_of(links_, direction, upper, cell, first_order_))
      flux.add(of, weight, block_of(blocks, cell, layout_.end(end.where)));
    add_flux(upper ? cell : -1, upper ? -1 : cell);
  }
}

/// Adds the force: an acceleration a yields the momentum ρa and the energy ρu·a per unit of time.
void moment_assembly::add_forces(block_matrix& to) const {
  const gas_model* gas = equation_.as_gas();
  if (!acts_.force || gas == nullptr) return;
  const int energy = count_ - 1;
  for (const int cell : links_.cells()) {
    const auto a = acts_.force->value(0.0, space_.mesh().centre(cell));
    const int first = number_[at(cell)] * count_;
    for (int k = 0; k < gas->molecules().dimensions(); ++k) {
      if (a[at(k)] == 0.0) continue;
      to.entry(first + 1 + k, first) -= a[at(k)];
      to.entry(first + energy, first + 1 + k) -= a[at(k)];
    }
  }
}

/// Returns the weights of the moments of cells in a difference along r; empty without neighbours.
std::vector<std::pair<int, double>> moment_assembly::radial_gradient(int cell) const {
  const int radial = layout_.radial();
  std::vector<std::pair<int, double>> found;
  if (const int group = cut_.group_of(cell); group >= 0) {
    double sum = 0.0;
    for (const auto& [one, weight] : gradient_weights(*space_.mesh().cut(), group)) {
      found.emplace_back(one, weight[at(radial)]);
      sum += weight[at(radial)];
    }
    if (!found.empty()) found.emplace_back(cell, -sum);
    return found;
  }
  const int above = links_.next(radial, true, cell), below = links_.next(radial, false, cell);
  if (above < 0 && below < 0) return found;
  const double per_length = (above < 0 || below < 0 ? 1.0 : 0.5) / space_.mesh().spacing(radial);
  found.emplace_back(above < 0 ? cell : above, per_length);
  found.emplace_back(below < 0 ? cell : below, -per_length);
  return found;
}

/// Adds the rotation A f of f = E + (A E − v_r ∂_r E)/σ. Its part with the deviation is left out where no
/// neighbour gives a gradient: in uniform gas, which F = r f makes linear in r, both terms cancel.
void moment_assembly::add_rotation(std::span<const double> blocks, block_matrix& to) const {
  for (const int cell : links_.cells()) {
    const int row = number_[at(cell)];
    add_block(row, row, -1.0, block_of(blocks, cell, layout_.turn()), to);
    const auto gradient = radial_gradient(cell);
    if (gradient.empty()) continue;
    add_block(row, row, -1.0, block_of(blocks, cell, layout_.turned_twice()), to);
    for (const auto& [of, weight] : gradient)
      add_block(row, number_[at(of)], weight, block_of(blocks, cell, layout_.moved_then_turned()), to);
  }
}

void moment_assembly::find_conserved(moment_equations& all) const {
  const int unknowns = mesh_.unknowns();
  std::vector<double> sums(at(count_) * at(unknowns), 0.0), sizes(at(count_), 0.0);
  const auto add = [&](const block_matrix& some) {
    for (int row = 0; row < some.rows(); ++row)
      some.visit_row(row, [&](int column, const double* block) {
        for (int i = 0; i < count_; ++i)
          for (int j = 0; j < count_; ++j) {
            const double value = mesh_.volume(row) * block[i * count_ + j];
            sums[at(i) * at(unknowns) + at(column * count_ + j)] += value;
            sizes[at(i)] = std::max(sizes[at(i)], std::abs(value));
          }
      });
  };
  for (const block_matrix& some : all.along) add(some);
  add(all.inside);
  // Fluxes between cells cancel to rounding. Fluxes at ends cancel only to half of the digits, because they
  // are differences of rows.
  constexpr double rounding = 1e-7;
  for (int moment = 0; moment < count_; ++moment) {
    const auto first = sums.begin() + static_cast<std::ptrdiff_t>(moment) * unknowns;
    const double largest = std::abs(*std::max_element(
        first, first + unknowns, [](double a, double b) { return std::abs(a) < std::abs(b); }));
    if (largest <= rounding * sizes[at(moment)]) all.conserved.push_back(moment);
  }
}

}  // namespace apsis
