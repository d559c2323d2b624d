#include "cached_sweeps.hpp"

#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/semidiscrete/block_sweep.hpp>
#include <apsis/semidiscrete/tiling.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace apsis::bench {
namespace {

constexpr int columns = 32,  ///< components of a sweep, as in a step
    halo = 2;                ///< cells beyond a run whose edges its limiter needs

grid mesh_of(const case_config& config) {
  const std::vector<int>& cells = config.space.cells;
  std::array<int, 3> all = {1, 1, 1};
  std::copy(cells.begin(), cells.end(), all.begin());
  return grid(static_cast<int>(cells.size()), all, {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0});
}

}  // namespace

cached_sweeps::cached_sweeps(const case_config& config, int accumulators)
    : scheme_(find_reconstruction(config.space.reconstruction).make()) {
  const int beyond = halo + scheme_->ghost_width();
  const cell_box box = tiling(mesh_of(config), sweep_block_length(columns), 1).box(0);
  int longest = 0;
  for (std::size_t k = 0; k < config.space.cells.size(); ++k) longest = std::max(longest, box.cells[k]);
  const auto rows = static_cast<std::size_t>(longest + 2 * beyond);
  u_.resize(rows * columns);
  edges_.resize(rows * columns);
  accumulators_.resize(rows * columns * static_cast<std::size_t>(accumulators));
  for (int k = 0; k < accumulators; ++k)
    targets_.push_back(
        {accumulators_.data() + static_cast<std::size_t>(k) * rows * columns, columns, 0.0, 1e-6, false});
  for (std::size_t k = 0; k < u_.size(); ++k) u_[k] = 1.0 + 0.1 * std::sin(0.01 * static_cast<double>(k));
  speeds_.assign(columns, 1.0);
  for (int k = 0; k < columns; ++k)  // as for equally spaced velocities
    capacities_.push_back(columns / std::abs(columns - 1.0 - 2.0 * k));
  forward_.assign(columns, 0.0);
  std::fill_n(forward_.begin(), columns / 2, 1.0);
  for (std::size_t k = 0; k < config.space.cells.size(); ++k) {
    sweep one{{}, box.cells[k]};
    for (int i = 0; i < one.cells + 2 * beyond; ++i)
      one.rows.push_back(u_.data() + static_cast<std::size_t>(i) * columns);
    sweeps_.push_back(std::move(one));
  }
}

void cached_sweeps::evaluate(int times) {
  const int beyond = halo + scheme_->ghost_width();
  for (int time = 0; time < times; ++time)
    for (const sweep& one : sweeps_) {
      const double* const* first = one.rows.data() + beyond - halo;
      scheme_->outflow_edges(first, one.cells + 2 * halo, columns, forward_.data(), edges_.data());
      const double* edges = edges_.data() + halo * columns;
      const upwind::cells run{first + halo,       edges,   edges,           columns,
                              one.cells,          columns, forward_.data(), speeds_.data(),
                              capacities_.data(), nullptr};
      upwind::add_limited(run, targets_);
    }
}

double cached_sweeps::numbers() const {
  double cells = 0.0;
  for (const sweep& one : sweeps_) cells += one.cells;
  return columns * cells;
}

}  // namespace apsis::bench
