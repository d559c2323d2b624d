#include <apsis/steady/steady_solver.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/exec/global_sum.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/semidiscrete/gathered_cells.hpp>
#include <apsis/steady/anderson.hpp>
#include <apsis/steady/cell_links.hpp>
#include <apsis/steady/cut_links.hpp>
#include <apsis/steady/damping.hpp>
#include <apsis/steady/internal/cell_measures.hpp>
#include <apsis/steady/macroscopic_system.hpp>
#include <apsis/steady/octant_sweep.hpp>
#include <apsis/steady/rarer_gases.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// J is built anew where a moment has changed by more than this share of its scale,
constexpr double change_for_new_system = 0.1;
/// until the residual is this share of that of the start. It is kept then.
constexpr double share_to_keep_system = 0.01;
/// A residual that has grown by this factor since J was built calls for a new one.
constexpr double growth_for_new_system = 10.0;
/// So does a pseudo-time term that is this many times the present one.
constexpr double change_of_pseudo_rate = 10.0;
/// In a dense gas images mislead the mixture until the residual is this share of that of the start.
constexpr double share_to_mix = 0.05;
/// Rarefaction parameter √π/2 · L/λ below which a gas is rare, so that mixing pays from the first iteration
/// on.
constexpr double rare = 5.0;
/// Cells are thin where every one is at most so many mean free paths wide. J is of first order then: the
/// viscosity of its fluxes is a part of that of the gas.
constexpr double widest_thin_cell = 1.5;
/// Slopes of the sweep. In a rare gas f varies fast across rays. A sweep that diffuses less then needs fewer
/// iterations. In a dense gas strong flows need more iterations with second order.
constexpr double slope_in_thin_cells = 0.5, usual_slope = 0.35;
/// One iteration leaves at least this share of the temperature of every cell,
constexpr double lowest_cooling = 0.1;
/// if a correction of this share of its size can.
constexpr double smallest_share = 1e-3;
/// A residual of this multiple of the start does not come back.
constexpr double hopeless = 1e6;

/// Returns ε of the cells. Throws input_error where there is no steady state to solve for.
std::vector<double> checked_epsilon(const problem_builder& space) {
  if (!space.has_space())
    throw input_error("the model has no space, so that its steady state is an equilibrium; run it in time");
  if (space.axis())
    throw input_error(
        "the steady state of axisymmetric flow (sweeps do not turn velocities around the axis); march in "
        "time");
  std::vector<double> found;
  run_collectively(space.processes(), [&] {
    found = space.epsilon_at_centres();
    for (const double epsilon : found)
      if (!(epsilon > 0.0))
        throw input_error("epsilon is 0 in some cell (the steady solver divides by it); give a positive one");
  });
  return found;
}

std::vector<double> sum_of(const std::vector<double>& a, double share, const std::vector<double>& b) {
  std::vector<double> found(a);
  for (std::size_t k = 0; k < a.size(); ++k) found[k] += share * b[k];
  return found;
}

}  // namespace

bool is_nonnegative(const relaxation_model& equation, const problem_builder& space) {
  return equation.positive() && equation.collisions_keep_sign() && equation.why_signed().empty() &&
         !equation.has_source() && space.keeps_sign() && space.collisions().reach == 0;
}

struct steady_solver::impl {
  impl(const relaxation_model& of, const problem_builder& space, semidiscrete_problem& operators,
       const field& start, const steady_options& given)
      : equation(of),
        builder(space),
        processes(space.processes()),
        options(given),
        epsilon(checked_epsilon(space)),
        problem(operators),
        links(builder.space()),
        cut(builder.space()),
        count(equation.moment_count()),
        cells(equation, builder, links),
        is_thin(has_thin_cells(start)),
        system(equation, builder, links, is_thin),
        sweep(equation, builder.space(), links, cut, is_thin ? slope_in_thin_cells : usual_slope),
        mixture(given.depth),
        r(start.cells(), start.components()),
        omega(at(start.cells() * count)),
        of_transport(omega.size()),
        changes_of_moments(omega.size()),
        rates(at(start.cells())) {
    cells.moments_of(start, omega);
    totals = cells.sums(omega);
    scales = cells.largest_scales(omega);
  }

  /// r ← T(f) + Q(f)/ε, with the moments of f and of T(f), and the rates.
  void compute_residual(const field& f) {
    const std::array<target<field, double>, 1> fresh = {{{&r, 0.0, 1.0, true}}};
    problem.add_transport(0.0, f, fresh);
    cells.moments_of(f, omega);
    cells.moments_of(r, of_transport);
    const std::array<target<field, double>, 1> added = {{{&r, 0.0, 1.0, false}}};
    problem.add_collision(0.0, f, added);
    problem.throw_late_errors();
    find_rates(omega, rates);
  }

  /// Whether all cells are thin at the state of the start.
  bool has_thin_cells(const field& start) const {
    std::vector<double> moments(at(start.cells() * count)), now(at(start.cells()));
    cells.moments_of(start, moments);
    find_rates(moments, now);
    return cells.largest_optical_width(moments, now) <= widest_thin_cell;
  }

  /// to ← C/ε of the cells.
  void find_rates(const std::vector<double>& moments, std::vector<double>& to) const {
    for (const int cell : links.cells())
      to[at(cell)] = equation.rate(moments.data() + at(cell * count)) / epsilon[at(cell)];
  }

  /// Returns the largest relative change of a moment since J was built.
  double change_since_system() {
    std::vector<double> change(omega);
    for (std::size_t k = 0; k < change.size(); ++k) change[k] -= omega_of_system[k];
    return cells.largest_relative_change(omega_of_system, change);
  }

  void build_system_if_due(double relative) {
    const double vanishing = flight_rate * damped.vanishing_rate(relative),
                 constant = flight_rate * damped.constant_rate();
    const bool due = !built || relative > growth_for_new_system * lowest ||
                     pseudo_rate > change_of_pseudo_rate * std::max(vanishing, constant) ||
                     (relative > share_to_keep_system && change_since_system() > change_for_new_system);
    lowest = due ? relative : std::min(lowest, relative);
    if (!due) {
      kept = true;
      return;
    }
    omega_of_system = omega;
    // A neutral mode takes any change. If it is the cause, nothing else needs to be damped.
    pseudo_rate = 0.0;
    holds_neutral_mode = constant > 0.0 && seeks_neutral_mode && system.build(omega, rates, 0.0, true);
    if (constant > 0.0) seeks_neutral_mode = holds_neutral_mode;  // once for each term
    if (!holds_neutral_mode) {
      pseudo_rate = std::max(vanishing, constant);
      system.build(omega, rates, pseudo_rate);
    }
    if (built && kept) mixture.clear();
    built = true;
    kept = false;
  }

  /// r ← r + σ (E(ω + share δω) − E(ω)); less of δω where that has no equilibrium.
  void add_correction(double share) {
    parallel_blocks(static_cast<int>(links.cells().size()), cells_of_a_block, [&](int begin, int end) {
      aligned_vector<double> before(at(r.components())), after(at(r.components()));
      std::vector<double> moved(at(count));
      for (int n = begin; n < end; ++n) {
        const int cell = links.cells()[at(n)];
        const double *here = omega.data() + at(cell * count),
                     *change = changes_of_moments.data() + at(cell * count);
        if (!equation.equilibrium(here, before.data()))
          throw numerical_error(equation.why_inadmissible(here),
                                {.cell = builder.space().number_in_whole_mesh(cell), .value = here[0]});
        for (double part = share; part > 1e-3 * share; part *= 0.5) {
          for (std::size_t i = 0; i < at(count); ++i) moved[i] = here[i] + part * change[i];
          if (!equation.equilibrium(moved.data(), after.data())) continue;
          for (std::size_t k = 0; k < after.size(); ++k)
            r.row(cell)[k] += rates[at(cell)] * (after[k] - before[k]);
          break;
        }
      }
    });
  }

  /// f ← f + δ, mixed with earlier images, with the total mass of the start where walls enclose it. Less of
  /// δ where it leaves too little temperature, and the image itself where the mixture does.
  void update(field& f, bool mix) {
    const auto section = timed(kernel::mixture, f.components());
    std::vector<double> change(omega.size());
    cells.moments_of(r, change);
    double share = 1.0;
    anderson::weights weights{{}, sum_of(omega, 1.0, change)};
    while (share > smallest_share && !cells.keeps_temperature(omega, weights.of_mixture, lowest_cooling)) {
      share *= 0.5;
      weights.of_mixture = sum_of(omega, share, change);
    }
    if (share < 1.0 || !mix) {
      mixture.clear();
    } else {
      for (std::size_t k = 0; k < change.size(); ++k) change[k] /= scales[k % at(count)];
      anderson::weights mixed =
          mixture.weigh(processes, gather_cells(builder, std::move(change), count), weights.of_mixture);
      if (cells.keeps_temperature(omega, mixed.of_mixture, lowest_cooling)) weights = std::move(mixed);
    }
    const bool is_closed = equation.as_gas() != nullptr && system.conserved()[0];
    const double factor = is_closed ? totals[0] / cells.sums(weights.of_mixture)[0] : 1.0;
    if (mix && share == 1.0)
      mixture.move(weights, r, factor, f);
    else
      move(r, share, factor, f);
  }

  bool begin_again() {
    if (damped.strength() == damping::strongest()) return false;
    restart(damped.strength() + 1);
    return true;
  }

  void restart(int strength) {
    damped = damping(strength);
    lowest = pseudo_rate = 0.0;
    holds_neutral_mode = false;
    forget_system();
  }

  /// Begins with another J.
  void forget_system() {
    built = false;
    seeks_neutral_mode = true;
    mixture.clear();
  }

  [[noreturn]] static void throw_imbalance(double residual) {
    throw steady_imbalance(fmt::format(
        "no steady state is found: the residual stays at {:.2g} of that of the start (a front has no "
        "position at which the fluxes of the ends are equal); give the ends states with equal "
        "fluxes, more velocities, or a larger steady.tolerance",
        residual));
  }

  /// Times the enclosing scope on all threads.
  profile::section timed(kernel which, double numbers_of_cell) const {
    return {which, static_cast<double>(links.cells().size()) * numbers_of_cell, {}, threads()};
  }

  /// Sets δω and its size.
  void correct_moments(steady_iteration& now) {
    build_system_if_due(now.residual);
    std::vector<double> missing = cells.sums(omega);
    for (std::size_t i = 0; i < missing.size(); ++i) missing[i] = totals[i] - missing[i];
    changes_of_moments = system.solve(of_transport, missing);
    now.change = cells.largest_relative_change(omega, changes_of_moments);
  }

  /// Removes what the tolerance leaves below 0, if the steady state is not negative. Where the residual is
  /// then above the tolerance, more iterations follow.
  void remove_negatives(field& f, steady_iteration& now) {
    if (!is_nonnegative(equation, builder)) return;
    removed_values& removed = now.removed;
    run_collectively(processes, [&] { removed = remove_negative_values(equation, links.cells(), f); });
    removed.count = global_count(processes, removed.count);
    removed.lowest = global_lowest(processes, removed.lowest);
    if (removed.count == 0) return;
    cut.copy_rows(f);
    mixture.clear();
    compute_residual(f);
    if (reference > 0.0) now.residual = cells.norm(r) / reference;
    now.converged = now.residual <= options.tolerance || now.rounding;
  }

  steady_iteration iterate(field& f) {
    compute_residual(f);
    const double residual = cells.norm(r);
    constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();
    // ‖σf‖ changes too little to be needed far above rounding.
    if (number == 0 || residual <= 1e3 * rounding * collisions) collisions = cells.weighted_norm(f, rates);
    if (number == 0) {
      flight_rate = cells.thermal_speed(omega) / cells.extent();
      optical_length = cells.mean(rates) / flight_rate;
      mixes_at_once = optical_length / std::numbers::sqrt2 < rare;  // √π/2 · L/λ
    }
    if (std::isnan(reference)) reference = residual;
    steady_iteration now;
    now.number = number++;
    now.residual = reference > 0.0 ? residual / reference : 0.0;
    if (!(now.residual < hopeless))
      throw numerical_error(
          fmt::format("the iteration to the steady state diverges: its residual is {:.3g} "
                      "times that of the start; march in time",
                      now.residual));
    if (damped.note_residual(now.residual)) {
      if (holds_neutral_mode) throw_imbalance(now.residual);
      forget_system();
    }
    // Each term of a residual is rounded relative to σf.
    now.rounding = residual <= rounding * collisions;
    correct_moments(now);
    if (damped.note_change(now.change)) {
      forget_system();
      correct_moments(now);
    }
    now.damping = damped.strength();
    if (!std::isfinite(now.change))
      throw numerical_error(
          "the correction of the moments is not finite: the iteration to the steady state diverges; march in "
          "time");
    now.converged = (now.residual <= options.tolerance || now.rounding) && now.change <= options.tolerance;
    if (now.converged) {
      remove_negatives(f, now);
      return now;
    }
    const double share = cells.largest_share(omega, changes_of_moments, damping::largest_change);
    run_collectively(processes, [&] {
      const auto section = timed(kernel::implicit, f.components());
      add_correction(share);
      for (double& rate : rates) rate += pseudo_rate;
      sweep.solve(f, rates, r);
    });
    cut.copy_rows(r);
    update(f, mixes_at_once || now.residual < share_to_mix);
    return now;
  }

  const relaxation_model& equation;
  problem_builder builder;
  communicator& processes;
  steady_options options;
  std::vector<double> epsilon;
  semidiscrete_problem& problem;
  cell_links links;
  cut_links cut;
  int count;
  cell_measures cells;
  bool is_thin;  ///< every cell
  macroscopic_system system;
  octant_sweep sweep;
  anderson mixture;
  damping damped;
  field r;
  std::vector<double> omega, omega_of_system, of_transport, changes_of_moments, rates, totals, scales;
  double reference = std::numeric_limits<double>::quiet_NaN();
  double collisions = 0.0;           ///< ‖σf‖₂, of the start until the residual is small
  double lowest = 0.0;               ///< residual since J was built
  double optical_length = 0.0;       ///< collisions of a flight through the domain
  double flight_rate = 0.0;          ///< thermal speed over the extent of the domain
  double pseudo_rate = 0.0;          ///< of J
  bool built = false, kept = false,  ///< J, and more than once
      holds_neutral_mode = false, seeks_neutral_mode = true, mixes_at_once = false;
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
  impl_->restart(strength);
}

double steady_solver::relative_residual(const field& f) {
  impl_->compute_residual(f);
  return impl_->cells.norm(impl_->r) / impl_->reference;
}

double steady_solver::flight_time() const {
  return 1.0 / impl_->flight_rate;
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
  bool may_continue = true;
  // Returns whether f is the solution of a rarer gas now.
  const auto continues = [&] {
    rarer_gases rarer(impl_->equation, impl_->builder, rarer_gases::factors(optical_length()),
                      impl_->options.depth);
    if (!std::exchange(may_continue, false) || rarer.finished()) return false;
    f = start;
    while (!rarer.finished()) rarer.iterate(f);
    restart(rarer.damping());
    return true;
  };
  for (;;) {
    steady_iteration now;
    try {
      now = iterate(f);
    } catch (const steady_imbalance&) {
      throw;
    } catch (const steady_stall&) {
      if (!continues()) throw;
      continue;
    } catch (const numerical_error&) {
      if (begin_again())
        f = start;
      else if (!continues())
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
