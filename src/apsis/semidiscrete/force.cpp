#include <apsis/semidiscrete/force.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/scheme/limiter.hpp>
#include <apsis/semidiscrete/block_sweep.hpp>
#include <apsis/semidiscrete/force_losses.hpp>
#include <apsis/semidiscrete/global_integrals.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr double kappa = 1.0 / 12.0;  // CFL number of limited fluxes along velocities

std::size_t size(int n) {
  return static_cast<std::size_t>(n);
}

}  // namespace

/// Buffers of one thread.
struct force::workspace {
  aligned_vector<double> sum,  ///< change of the row of a cell
      into_last,               ///< fluxes into the last points of all lines
      scratch;                 ///< scratch memory of lattice_rows::add_changes()
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
      fifth_order_(edges.scheme->order() > 1),
      invariants_(equation.invariants().size()),
      workspaces_(std::make_unique<per_thread<workspace>>()) {
  if (lattice_.points.empty())
    throw input_error(
        "a force has no meaning (the velocities of the model are no lattice); use a model of a gas");
  check_velocities(acceleration_, lattice_);
  for (const double bound : acceleration_.largest)
    if (!(bound >= 0.0) || std::isinf(bound))
      throw input_error(
          fmt::format("the largest acceleration is {} (a finite number is needed); change it", bound));
  of_cells_.resize(size(space_->mesh().size()) * (invariants_ + force_losses::size(invariants_)));
  given_.resize(invariants_);
  losses_.resize(force_losses::size(invariants_));
}

double force::rate() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < lattice_.points.size(); ++k)
    if (acceleration_.largest[k] > 0.0) sum += acceleration_.largest[k] / lattice_.spacing[k];
  return limited_ ? sum / kappa : sum;
}

/// Returns the layout of the rows along a direction.
lattice_rows::layout force::layout_along(std::size_t direction) const {
  const int points = lattice_.points[direction];
  int apart = 1;
  for (std::size_t k = direction + 1; k < lattice_.points.size(); ++k) apart *= lattice_.points[k];
  return {equation_.components() / (points * apart), points, apart};
}

void force::prepare(const field& u) const {
  std::size_t most_lines = 0;
  int most_points = 0;
  for (std::size_t k = 0; k < lattice_.points.size(); ++k) {
    most_lines = std::max(most_lines, layout_along(k).lines());
    most_points = std::max(most_points, lattice_.points[k]);
  }
  workspaces_->prepare([&](workspace& here) {
    here.sum.resize(size(u.stride()));
    here.into_last.resize(most_lines);
    here.scratch.resize(lattice_rows::scratch_size(most_points));
  });
}

void force::add(double t, const field& u, std::span<const target<field, double>> targets, int begin,
                int end) const {
  const profile::section timed(kernel::forces, static_cast<double>(end - begin) * u.stride(),
                               traffic(targets));
  for (int cell = begin; cell < end; ++cell) add_cell(t, u, targets, cell, workspaces_->here());
}

void force::integrate() const {
  const std::vector<double> all = global_integrals(*space_, of_cells_, sums_of_cell());
  const auto first_loss = all.begin() + static_cast<std::ptrdiff_t>(invariants_);
  std::copy(all.begin(), first_loss, given_.begin());
  std::copy(first_loss, all.end(), losses_.begin());
}

void force::balance(std::span<const double> sums, const std::function<std::array<double, 3>(int)>& at) const {
  std::copy(sums.begin(), sums.end(), of_cells_.begin());
  for_cells_in(space_->mesh().fluid(), 0, space_->mesh().size(), [&](int begin, int end) {
    for (int cell = begin; cell < end; ++cell)
      set_losses(at(cell), of_cells_.data() + size(cell) * sums_of_cell());
  });
  integrate();
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
  double* sums = of_cells_.data() + size(cell) * sums_of_cell();
  double held = 0.0;
  bool fresh = true;
  for (std::size_t direction = 0; direction < lattice_.points.size(); ++direction) {
    if (a[direction] == 0.0) continue;
    held += add_direction(u.row(cell), direction, a[direction], fresh, here);
    fresh = false;
  }
  if (fresh) {
    std::fill_n(sums, sums_of_cell(), 0.0);
    return;
  }
  equation_.invariant_densities(here.sum.data(), sums);
  equation_.invariant_densities(u.row(cell), sums + invariants_);
  sums[sums_of_cell() - 1] = held;
  set_losses(a, sums);
  for (const auto& to : targets)
    lattice_rows::add(here.sum.data(), to.beta, u.components(), to.acc->row(cell));
}

/// Replaces the invariants of a row by the losses: mass, momentum and energy of a gas.
void force::set_losses(const std::array<double, 3>& a, double* sums) const {
  double* losses = sums + invariants_;
  const double mass = losses[force_losses::held], held = losses[invariants_];
  double power = 0.0, square = 0.0;
  for (std::size_t k = 0; k < lattice_.points.size(); ++k) {
    power += losses[force_losses::lost + k] * a[k];
    square += a[k] * a[k];
    losses[force_losses::lost + k] = mass * a[k] - sums[1 + k];
  }
  losses[force_losses::held] = held;
  losses[invariants_ - 1] = power - sums[invariants_ - 1];
  losses[invariants_] = mass * std::sqrt(square);
}

lattice_rows::flux_rule force::rule_for(double a) const {
  return {fifth_order_, limited_, a > 0.0, 1.0 / std::max(limiter::least_cfl_number, kappa * share_)};
}

/// Adds −a ∂f/∂v along one direction to the sum, or sets the sum. Returns the mass that enters
/// the last points.
double force::add_direction(const double* row, std::size_t direction, double a, bool fresh,
                            workspace& here) const {
  const lattice_rows::layout at = layout_along(direction);
  const lattice_rows::flux_rule rule = rule_for(a);
  const double rate = rate_along(direction, a);
  lattice_rows::add_changes(at, rule, rate, row, fresh, here.sum.data(), here.into_last.data(),
                            here.scratch.data());
  return rate * mass_into_ends(at, rule.forward, here.into_last.data());
}

/// Only the first set of functions on the velocities counts: it is the density of the mass.
double force::mass_into_ends(const lattice_rows::layout& at, bool forward, const double* into_last) const {
  const auto weights = equation_.velocities().weights();
  const auto velocities = static_cast<int>(weights.size());
  const int last = forward ? at.block() - at.apart : 0;
  double mass = 0.0;
  for (int block = 0; block < at.blocks; ++block) {
    const int first = block * at.block() + last, count = std::min(at.apart, velocities - first);
    if (count <= 0) return mass;
    for (int k = 0; k < count; ++k) mass += weights[size(first + k)] * into_last[block * at.apart + k];
  }
  return mass;
}

}  // namespace apsis
