#include <apsis/semidiscrete/force.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/first_error.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/semidiscrete/block_sweep.hpp>
#include <apsis/semidiscrete/global_integrals.hpp>
#include <apsis/semidiscrete/upwind_rows.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr int halo = 2,               // cells beyond a line whose edges limited fluxes see
    reach = 2,                        // cells on either side on which an edge depends
    beyond = halo + reach;            // rows of vacuum at either end of a line
constexpr double kappa = 1.0 / 12.0;  // of limited fluxes along velocities
constexpr int enough_lanes = 64;      // lines of several cells are swept together, so that they fill vectors
constexpr int cells_of_task = 64;     // some blocks of lines

std::size_t size(int n) {
  return static_cast<std::size_t>(n);
}

}  // namespace

/// Buffers of one thread. A "lane" is a line of the lattice: [point][lane].
struct force::workspace {
  aligned_vector<double> values, edges, change, forward, per_cell, inverse_cfl, in, out, sum;
  std::vector<const double*> rows;
  std::vector<std::array<double, 3>> a;  ///< of every cell of the block
  std::vector<upwind::row_target> target;
};

/// The lines along one direction of the cells begin … end−1.
struct force::place {
  int direction, begin, end;
};

force::~force() = default;
force::force(force&&) noexcept = default;

force::force(const model& equation, std::shared_ptr<domain> space, acceleration of,
             const limited_reconstruction& edges)
    : equation_(equation),
      space_(std::move(space)),
      lattice_(equation.lattice()),
      acceleration_(std::move(of)),
      limited_(edges.keeps_sign()),
      scheme_(find_reconstruction(edges.scheme->order() == 1 ? "upwind1" : "upwind5").make()),
      invariants_(equation.invariants().size()),
      workspaces_(std::make_unique<per_thread<workspace>>()) {
  if (lattice_.points.empty())
    throw input_error(
        "a force has no meaning (the velocities of the model are no lattice); use a model of a gas");
  for (std::size_t k = 0; k < lattice_.points.size(); ++k)
    if (acceleration_.largest[k] > 0.0 && (lattice_.points[k] < 2 * reach + 1 || lattice_.spacing[k] == 0.0))
      throw input_error(fmt::format(
          "a force acts along velocity direction {} (its {} velocities are not at least {} with equal "
          "distances); use the set \"uniform\" there",
          k + 1, lattice_.points[k], 2 * reach + 1));
  for (const double bound : acceleration_.largest)
    if (!(bound >= 0.0) || std::isinf(bound))
      throw input_error(
          fmt::format("the largest acceleration is {} (a finite number is needed); change it", bound));
  of_cells_.resize(size(space_->mesh().size()) * (invariants_ + 1));
  given_.resize(invariants_);
}

double force::rate() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < lattice_.points.size(); ++k)
    if (acceleration_.largest[k] > 0.0) sum += acceleration_.largest[k] / lattice_.spacing[k];
  return limited_ ? sum / kappa : sum;
}

void force::add(double t, const field& u, std::span<const target<field, double>> targets) const {
  const auto [shortest, longest] = std::minmax_element(lattice_.points.begin(), lattice_.points.end());
  const int lanes = equation_.components() / *shortest;
  const int together = std::max(1, enough_lanes / lanes);
  const std::size_t line = size(*longest);
  workspaces_->prepare([&](workspace& here) {
    const std::size_t width = size(together) * size(lanes);
    here.values.assign((line + 2 * beyond) * width, 0.0);
    here.edges.resize((line + 2 * halo) * width);
    here.change.resize(line * width);
    for (auto* row : {&here.forward, &here.per_cell, &here.in, &here.out}) row->resize(width);
    here.inverse_cfl.assign(width, 1.0 / std::max(limiter::least_cfl_number, kappa * share_));
    here.sum.resize(size(together) * size(u.stride()));
    here.rows.resize(line + 2 * beyond);
    here.a.resize(size(together));
    here.target.reserve(1);
  });
  first_error failure;
  failure.run([&] {
    parallel_blocks(u.cells(), std::max(together, cells_of_task), [&](int begin, int end) {
      const profile::section timed(kernel::forces, static_cast<double>(end - begin) * u.stride(),
                                   traffic(targets));
      for_cells_in(space_->mesh().fluid(), begin, end, [&](int from, int to) {
        for (int first = from; first < to; first += together)
          add_cells(t, u, targets, first, std::min(to, first + together), workspaces_->here());
      });
    });
  });
  given_ = global_integrals(*space_, of_cells_, invariants_ + 1);
  held_ = given_.back();
  given_.pop_back();
  failure.rethrow();
}

void force::load_acceleration(double t, int begin, int end, workspace& here) const {
  for (int cell = begin; cell < end; ++cell) {
    auto& a = here.a[size(cell - begin)];
    a = acceleration_.value(t, space_->mesh().centre(cell));
    for (std::size_t k = 0; k < lattice_.points.size(); ++k)
      if (!(std::abs(a[k]) <= acceleration_.largest[k]))
        throw numerical_error(
            fmt::format(
                "the acceleration exceeds its bound {:.6g} (on which the step depends); use a smaller "
                "step or a smoother formula",
                acceleration_.largest[k]),
            {-1, t, cell, a[k]});
  }
}

void force::add_cells(double t, const field& u, std::span<const target<field, double>> targets, int begin,
                      int end, workspace& here) const {
  load_acceleration(t, begin, end, here);
  for (int cell = begin; cell < end; ++cell) sums_of(cell)[invariants_] = 0.0;
  std::fill(here.sum.begin(), here.sum.end(), 0.0);
  for (int direction = 0; direction < static_cast<int>(lattice_.points.size()); ++direction)
    if (acceleration_.largest[size(direction)] > 0.0) add_direction(u, {direction, begin, end}, here);
  store(u, targets, begin, end, here);
}

void force::add_direction(const field& u, const place& at, workspace& here) const {
  const int n = lattice_.points[size(at.direction)], lanes = equation_.components() / n,
            cells = at.end - at.begin;
  const int width = cells * lanes;
  std::ptrdiff_t apart = 1;
  for (std::size_t k = size(at.direction) + 1; k < lattice_.points.size(); ++k) apart *= lattice_.points[k];
  // First component of a lane.
  const auto first_of = [&](int lane) { return (lane / apart) * apart * n + lane % apart; };
  double* values = here.values.data() + static_cast<std::ptrdiff_t>(beyond) * width;
  std::fill(here.values.begin(), here.values.end(), 0.0);
  for (int cell = 0; cell < cells; ++cell) {
    const double a = here.a[size(cell)][size(at.direction)];
    for (int lane = 0; lane < lanes; ++lane) {
      const int column = cell * lanes + lane;
      const double* from = u.row(at.begin + cell) + first_of(lane);
      for (int i = 0; i < n; ++i) values[static_cast<std::ptrdiff_t>(i) * width + column] = from[i * apart];
      here.forward[size(column)] = a > 0.0 ? 1.0 : 0.0;
      here.per_cell[size(column)] = std::abs(a) / lattice_.spacing[size(at.direction)];
    }
  }
  for (int i = -beyond; i < n + beyond; ++i)
    here.rows[size(i + beyond)] = values + static_cast<std::ptrdiff_t>(i) * width;
  double* edges = here.edges.data() + static_cast<std::ptrdiff_t>(halo) * width;
  std::fill(here.edges.begin(), here.edges.end(), 0.0);  // nothing enters through the ends
  const double* const* rows = here.rows.data() + beyond;
  scheme_->outflow_edges(rows, n, width, here.forward.data(), edges);
  here.target.assign(1, {here.change.data(), width, 0.0, 1.0, true});
  const auto run_of = [&](int first, int count) {
    const double* of_first = edges + static_cast<std::ptrdiff_t>(first) * width;
    return upwind::cells{rows + first,
                         of_first,
                         of_first,
                         width,
                         count,
                         width,
                         here.forward.data(),
                         here.per_cell.data(),
                         here.inverse_cfl.data(),
                         nullptr};
  };
  if (limited_) {
    upwind::add_limited(run_of(0, n), here.target);
  } else {
    upwind::add(run_of(0, n), here.target);
  }
  for (const bool upper : {false, true}) {
    // The flux out of the last point stays there.
    const int last = upper ? n - 1 : 0;
    double* change = here.change.data() + static_cast<std::ptrdiff_t>(last) * width;
    upwind::fluxes_of_cell(run_of(last, 1), limited_, here.in.data(), here.out.data());
    for (std::size_t k = 0; k < size(width); ++k) {
      if ((here.forward[k] != 0.0) != upper) continue;
      change[k] += here.per_cell[k] * here.out[k];
      const int lane = static_cast<int>(k) % lanes;
      const int cell = at.begin + static_cast<int>(k) / lanes;
      sums_of(cell)[invariants_] +=
          mass_at(static_cast<int>(first_of(lane) + last * apart), here.per_cell[k] * here.in[k]);
    }
  }
  for (int cell = 0; cell < cells; ++cell)
    for (int lane = 0; lane < lanes; ++lane) {
      double* to = here.sum.data() + static_cast<std::ptrdiff_t>(cell) * u.stride() + first_of(lane);
      const double* from = here.change.data() + cell * lanes + lane;
      for (int i = 0; i < n; ++i) to[i * apart] += from[static_cast<std::ptrdiff_t>(i) * width];
    }
}

/// Of the functions on the velocities, the first is the density of the mass.
double force::mass_at(int component, double value) const {
  const auto weights = equation_.velocities().weights();
  return component < equation_.velocities().size() ? weights[size(component)] * value : 0.0;
}

void force::store(const field& u, std::span<const target<field, double>> targets, int begin, int end,
                  workspace& here) const {
  for (int cell = begin; cell < end; ++cell) {
    const double* change = here.sum.data() + static_cast<std::ptrdiff_t>(cell - begin) * u.stride();
    equation_.invariant_densities(change, sums_of(cell));
    for (const auto& to : targets) {
      double* acc = to.acc->row(cell);
      for (int k = 0; k < u.components(); ++k) {
        const double sum = acc[k] + to.beta * change[k];
        // Two roundings of subnormal numbers may exceed the value.
        const bool rounding = sum < 0.0 && sum > -std::numeric_limits<double>::min();
        acc[k] = rounding ? 0.0 : sum;
      }
    }
  }
}

}  // namespace apsis
