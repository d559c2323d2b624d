#include <apsis/steady/steady_solver.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/exec/global_sum.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/steady/cell_links.hpp>
#include <apsis/steady/continuation.hpp>
#include <apsis/steady/cut_links.hpp>
#include <apsis/steady/damping.hpp>
#include <apsis/steady/internal/cell_measures.hpp>
#include <apsis/steady/internal/equilibrium_changes.hpp>
#include <apsis/steady/internal/moment_correction.hpp>
#include <apsis/steady/internal/state_update.hpp>
#include <apsis/steady/internal/steady_residual.hpp>
#include <apsis/steady/octant_sweep.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

/// In a dense gas images mislead the mixture until the residual is below this part of that of the start.
constexpr double share_to_mix = 0.05;
/// Rarefaction parameter √π/2 · L/λ below which a gas is rare: mixing then helps from the first iteration.
constexpr double rare = 5.0;
/// Cells are thin if each is at most this many mean free paths wide. J is then of first order, because the
/// viscosity of its fluxes is only a part of the viscosity of the gas.
constexpr double widest_thin_cell = 1.5;
/// Slopes of the sweep. In a rare gas f varies fast across rays, so that a less diffusive sweep needs fewer
/// iterations. In a dense gas strong flows need more iterations with second order.
constexpr double slope_in_thin_cells = 0.5, usual_slope = 0.35;
/// The iteration diverges if the residual exceeds this multiple of that of the start.
constexpr double hopeless = 1e6;
/// Rounding of a residual, relative to ‖σf‖.
constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();

/// Returns ε of the cells. Throws input_error if there is no steady state to solve for.
std::vector<double> checked_epsilon(const problem_builder& space) {
  if (!space.has_space())
    throw input_error("the model has no space, so that its steady state is an equilibrium; run it in time");
  std::vector<double> found;
  run_collectively(space.processes(), [&] {
    found = space.epsilon_of_unknowns();
    for (const double epsilon : found)
      if (!(epsilon > 0.0))
        throw input_error("epsilon is 0 in some cell (the steady solver divides by it); give a positive one");
  });
  return found;
}

/// Returns the smallest of the numbers of some cells; +infinity without cells.
double lowest_of(const std::vector<double>& numbers, const std::vector<int>& cells) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const int cell : cells) lowest = std::min(lowest, numbers[at(cell)]);
  return lowest;
}

/// Limits a problem for steady states during its lifetime.
class steady_limits {
 public:
  steady_limits(semidiscrete_problem& of, double collisions) : of_(of) {
    of_.limit_for_steady_states(collisions);
  }
  ~steady_limits() { of_.limit_for_steps(1.0); }
  steady_limits(const steady_limits&) = delete;
  steady_limits& operator=(const steady_limits&) = delete;

 private:
  semidiscrete_problem& of_;
};

}  // namespace

bool is_nonnegative(const relaxation_model& equation, const problem_builder& space) {
  return equation.positive() && equation.collisions_keep_sign() && equation.why_signed().empty() &&
         !equation.has_source() && space.keeps_sign() && space.collisions().reach == 0;
}

struct steady_solver::impl {
  impl(const relaxation_model& of, const problem_builder& space, semidiscrete_problem& problem,
       const field& start, const steady_options& given)
      : equation(of),
        builder(space),
        processes(space.processes()),
        options(given),
        epsilon(checked_epsilon(space)),
        links(builder.space()),
        cut(builder.space()),
        cells(equation, builder, links),
        state(equation, problem, links, cells, epsilon, start),
        limits(problem, global_lowest(processes, lowest_of(state.rates, links.cells()))),
        is_thin(cells.largest_optical_width(state.omega, state.rates) <= widest_thin_cell),
        correction(equation, builder, links, cells, state, is_thin),
        turn(space.axis() ? std::optional(ring_turn(of.polar(), false)) : std::nullopt),
        sweep(equation, builder.space(), links, cut, is_thin ? slope_in_thin_cells : usual_slope,
              turn ? &*turn : nullptr),
        update(builder, cells, state.omega, given.depth) {}

  bool begin_again() {
    if (correction.strength() == damping::strongest()) return false;
    correction.restart(correction.strength() + 1);
    return true;
  }

  /// Times the enclosing scope on all threads.
  profile::section timed(kernel which, double numbers_of_cell) const {
    return {which, static_cast<double>(links.cells().size()) * numbers_of_cell, {}, threads()};
  }

  /// Removes negative values within the tolerance if steady states are nonnegative. If the residual then
  /// exceeds the tolerance, more iterations follow.
  void remove_negatives(field& f, steady_iteration& now) {
    if (!is_nonnegative(equation, builder)) return;
    removed_values& removed = now.removed;
    run_collectively(processes,
                     [&] { removed = remove_negative_values(equation, builder.space(), links.cells(), f); });
    removed.count = global_count(processes, removed.count);
    removed.lowest = global_lowest(processes, removed.lowest);
    if (removed.count == 0) return;
    cut.copy_rows(f);
    update.clear();
    state.compute(f);
    if (reference > 0.0) now.residual = cells.norm(state.r) / reference;
    now.converged = now.residual <= options.tolerance || now.rounding;
  }

  /// Sets the units of time and length from the first state.
  void note_first() {
    correction.set_flight_rate(cells.thermal_speed(state.omega) / cells.extent());
    optical_length = cells.mean(state.rates) / correction.flight_rate();
    mixes_at_first = optical_length / std::numbers::sqrt2 < rare;  // √π/2 · L/λ
  }

  /// Computes the residual of a state and the correction of its moments. Throws numerical_error if the
  /// iteration diverges, and steady_stall if it stalls.
  steady_iteration measure(const field& f) {
    state.compute(f);
    const double residual = cells.norm(state.r);
    // ‖σf‖ changes little, and is needed only near rounding.
    if (number == 0 || residual <= 1e3 * rounding * collisions)
      collisions = cells.weighted_norm(f, state.rates);
    if (number == 0) note_first();
    if (std::isnan(reference)) reference = residual;
    steady_iteration now;
    now.number = number++;
    now.residual = reference > 0.0 ? residual / reference : 0.0;
    if (!(now.residual < hopeless))
      throw numerical_error(
          fmt::format("the iteration to the steady state diverges: its residual is {:.3g} "
                      "times that of the start; march in time",
                      now.residual));
    correction.note_residual(now.residual);
    // Each term of a residual is rounded relative to σf.
    now.rounding = residual <= rounding * collisions;
    correction.find(state, now.residual);
    now.change = correction.size();
    now.damping = correction.strength();
    if (!std::isfinite(now.change))
      throw numerical_error(
          "the correction of the moments is not finite: the iteration to the steady state diverges; march in "
          "time");
    now.converged = (now.residual <= options.tolerance || now.rounding) && now.change <= options.tolerance;
    return now;
  }

  /// state.r ← δf.
  void find_change(const field& f) {
    const double share = cells.largest_share(state.omega, correction.changes(), damping::largest_change);
    run_collectively(processes, [&] {
      const auto section = timed(kernel::implicit, f.components());
      add_equilibrium_changes(equation, builder, links.cells(), state.omega, correction.changes(), share,
                              state.rates, state.r);
      for (double& rate : state.rates) rate += correction.pseudo_rate();
      sweep.solve(f, state.rates, state.r);
    });
    cut.copy_rows(state.r);
  }

  steady_iteration iterate(field& f) {
    const steady_iteration now = measure(f);
    if (now.converged) {
      steady_iteration last = now;
      remove_negatives(f, last);
      return last;
    }
    find_change(f);
    const auto section = timed(kernel::mixture, f.components());
    if (correction.takes_new_images()) update.clear();
    state_update::plan how{mixes_at_first || now.residual < share_to_mix, {}};
    if (equation.as_gas() != nullptr && correction.keeps_first_sum()) how.total_mass = correction.totals()[0];
    update.apply(how, state.omega, state.r, f);
    return now;
  }

  const relaxation_model& equation;
  problem_builder builder;
  communicator& processes;
  steady_options options;
  std::vector<double> epsilon;
  cell_links links;
  cut_links cut;
  cell_measures cells;
  steady_residual state;
  steady_limits limits;
  bool is_thin;  ///< whether all cells are thin
  moment_correction correction;
  std::optional<ring_turn> turn;  ///< in axisymmetric flow
  octant_sweep sweep;
  state_update update;
  double reference = std::numeric_limits<double>::quiet_NaN();
  double collisions = 0.0;      ///< ‖σf‖₂, that of the start until the residual is small
  double optical_length = 0.0;  ///< collisions during a flight through the domain
  bool mixes_at_first = false;
  int number = 0;
};

steady_solver::steady_solver(const relaxation_model& equation, const problem_builder& space,
                             semidiscrete_problem& problem, const field& start, const steady_options& options)
    : impl_(std::make_unique<impl>(equation, space, problem, start, options)) {}

steady_solver::~steady_solver() = default;

steady_iteration steady_solver::iterate(field& f) {
  return impl_->iterate(f);
}

bool steady_solver::begin_again() {
  return impl_->begin_again();
}

void steady_solver::restart(int strength) {
  impl_->correction.restart(strength);
}

double steady_solver::relative_residual(const field& f) {
  impl_->state.compute(f);
  return impl_->cells.norm(impl_->state.r) / impl_->reference;
}

double steady_solver::flight_time() const {
  return 1.0 / impl_->correction.flight_rate();
}

double steady_solver::optical_length() const {
  return impl_->optical_length;
}

double steady_solver::reference() const {
  return impl_->reference;
}

void steady_solver::set_reference(double residual) {
  impl_->reference = residual;
}

steady_iteration steady_solver::solve(field& f, const std::function<void(const steady_iteration&)>& watch) {
  const field start = f;
  std::size_t tried = 0;
  // Returns true if f has become the solution of an easier problem.
  const auto continues = [&](std::size_t allowed) {
    while (tried < allowed) {
      const auto easier = make_continuation(tried++, impl_->equation, impl_->builder, start, optical_length(),
                                            impl_->options.depth);
      if (!easier) continue;
      f = start;
      try {
        while (!easier->finished()) easier->iterate(f);
      } catch (const numerical_error&) {
        continue;
      }
      restart(easier->damping());
      return true;
    }
    return false;
  };
  for (;;) {
    steady_iteration now;
    try {
      now = iterate(f);
    } catch (const steady_imbalance&) {
      throw;
    } catch (const steady_stall& stall) {
      if (!continues(continuations_after(stall))) throw;
      continue;
    } catch (const numerical_error&) {
      if (begin_again())
        f = start;
      else if (!continues(continuations))
        throw;
      continue;
    }
    if (watch) watch(now);
    if (now.converged) return now;
    if (now.number + 1 >= impl_->options.iterations)
      throw numerical_error(
          fmt::format("no steady state in {} iterations (the residual is {:.3g} of that of "
                      "the start, the last change {:.3g}); give more, or march in time",
                      impl_->options.iterations, now.residual, now.change));
  }
}

}  // namespace apsis
