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

constexpr int least_points = 5;       // on which an edge depends
constexpr double kappa = 1.0 / 12.0;  // of limited fluxes along velocities
constexpr int cells_of_task = 16;

std::size_t size(int n) {
  return static_cast<std::size_t>(n);
}

}  // namespace

/// Buffers of one thread, of the longest layout.
struct force::workspace {
  aligned_vector<double> values, edges, out;                ///< [place]
  aligned_vector<double> still, moving, rate, inverse_cfl;  ///< [place]: 0, 1, a number of upwind::cells, 1/κ
  aligned_vector<double> sum;                               ///< change of the row of a cell
  lattice_rows::layout laid_out{};                          ///< of the values, whose gaps are 0
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
    if (acceleration_.largest[k] > 0.0 && (lattice_.points[k] < least_points || lattice_.spacing[k] == 0.0))
      throw input_error(fmt::format(
          "a force acts along velocity direction {} (its {} velocities are not at least {} with equal "
          "distances); use the set \"uniform\" there",
          k + 1, lattice_.points[k], least_points));
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

/// The layout of the rows along a direction.
lattice_rows::layout force::layout_along(std::size_t direction) const {
  const int points = lattice_.points[direction];
  int apart = 1;
  for (std::size_t k = direction + 1; k < lattice_.points.size(); ++k) apart *= lattice_.points[k];
  return {equation_.components() / (points * apart), points, apart};
}

void force::add(double t, const field& u, std::span<const target<field, double>> targets) const {
  std::size_t longest = 0;
  for (std::size_t k = 0; k < lattice_.points.size(); ++k)
    longest = std::max(longest, layout_along(k).size());
  workspaces_->prepare([&](workspace& here) {
    if (here.values.size() != longest) {
      for (auto* zeros : {&here.values, &here.edges, &here.out, &here.still, &here.rate})
        zeros->assign(longest, 0.0);
      here.moving.assign(longest, 1.0);
      here.sum.resize(size(u.stride()));
    }
    here.inverse_cfl.assign(longest, 1.0 / std::max(limiter::least_cfl_number, kappa * share_));
  });
  first_error failure;
  failure.run([&] {
    parallel_blocks(u.cells(), cells_of_task, [&](int begin, int end) {
      const profile::section timed(kernel::forces, static_cast<double>(end - begin) * u.stride(),
                                   traffic(targets));
      for_cells_in(space_->mesh().fluid(), begin, end, [&](int from, int to) {
        for (int cell = from; cell < to; ++cell) add_cell(t, u, targets, cell, workspaces_->here());
      });
    });
  });
  given_ = global_integrals(*space_, of_cells_, invariants_ + 1);
  held_ = given_.back();
  given_.pop_back();
  failure.rethrow();
}

std::array<double, 3> force::acceleration_in(double t, int cell) const {
  const auto a = acceleration_.value(t, space_->mesh().centre(cell));
  for (std::size_t k = 0; k < lattice_.points.size(); ++k)
    if (!(std::abs(a[k]) <= acceleration_.largest[k]))
      throw numerical_error(
          fmt::format("the acceleration exceeds its bound {:.6g} (on which the step depends); use a smaller "
                      "step or a smoother formula",
                      acceleration_.largest[k]),
          {-1, t, cell, a[k]});
  return a;
}

void force::add_cell(double t, const field& u, std::span<const target<field, double>> targets, int cell,
                     workspace& here) const {
  const auto a = acceleration_in(t, cell);
  double* sums = of_cells_.data() + static_cast<std::size_t>(cell) * (invariants_ + 1);
  std::fill(here.sum.begin(), here.sum.end(), 0.0);
  double held = 0.0;
  for (std::size_t direction = 0; direction < lattice_.points.size(); ++direction)
    if (a[direction] != 0.0) held += add_direction(u.row(cell), direction, a[direction], here);
  equation_.invariant_densities(here.sum.data(), sums);
  sums[invariants_] = held;
  for (const auto& to : targets)
    lattice_rows::add(here.sum.data(), to.beta, u.components(), to.acc->row(cell));
}

/// Adds −a ∂f/∂v along one direction to the sum; returns the mass that enters the last points.
double force::add_direction(const double* row, std::size_t direction, double a, workspace& here) const {
  const lattice_rows::layout at = layout_along(direction);
  const bool forward = a > 0.0;
  const double rate = std::abs(a) / lattice_.spacing[direction];
  // Nothing enters through the ends: the gaps are empty, and have no edges.
  if (!(at == here.laid_out)) {
    for (auto* places : {&here.values, &here.edges, &here.out})
      std::fill(places->begin(), places->end(), 0.0);
    here.laid_out = at;
  }
  lattice_rows::lay_out(at, row, here.values.data());
  const double* first = here.values.data() + at.first();
  std::array<const double*, 2 * 2 + 1> neighbours{};
  for (int i = -2; i <= 2; ++i) neighbours[size(i + 2)] = first + i * at.apart;
  const double* const* rows = neighbours.data() + 2;
  const double* motion = (forward ? here.moving : here.still).data();
  scheme_->outflow_edges(rows, 1, at.lanes(), motion, here.edges.data() + at.first());
  lattice_rows::clear_gaps(at, here.edges.data());
  const double* edges = here.edges.data() + at.first();
  const upwind::cells all{
      rows,   edges, edges, at.apart, 1, at.lanes(), motion, here.rate.data(), here.inverse_cfl.data(),
      nullptr};
  upwind::fluxes_out_of_cell(all, limited_, here.out.data() + at.first());
  lattice_rows::clear_ends(at, forward, here.out.data());
  lattice_rows::add_differences(at, here.out.data(), forward, rate, here.sum.data());
  return rate * mass_into_ends(at, forward, here.out.data());
}

/// Of the functions on the velocities, the first is the density of the mass.
double force::mass_into_ends(const lattice_rows::layout& at, bool forward, const double* out) const {
  const auto weights = equation_.velocities().weights();
  const int last = forward ? at.block() - at.apart : 0, upstream = forward ? -at.apart : at.apart;
  double mass = 0.0;
  for (int block = 0; block < at.blocks; ++block)
    for (int k = 0; k < at.apart; ++k) {
      const int component = block * at.block() + last + k;
      if (component >= equation_.velocities().size()) return mass;
      mass += weights[size(component)] * out[at.first() + block * at.pitch() + last + k + upstream];
    }
  return mass;
}

}  // namespace apsis
