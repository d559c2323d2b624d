#include <apsis/model/polar_maxwellian.hpp>

#include <apsis/model/grid_sums.hpp>
#include <apsis/model/internal/ring_exponentials.hpp>
#include <apsis/model/nonnegative_row.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>

namespace apsis {
namespace {

/// Moments of a vacuum up to this size count as 0.
constexpr double no_mass = 1e-300;

using ring_exponentials::components;
using ring_exponentials::dual_sums;
using ring_exponentials::factors;
using ring_parameters = ring_exponentials::parameters;

/// Newton's method for the minimum of the dual. At the minimum the means of ψ are (0, 0, 0, (3/2)T).
class dual_minimum {
 public:
  /// `square` is ⟨|v|²⟩. `width` is T of the first iterate.
  dual_minimum(factors& of, double T, double square, double width)
      : of_(of), T_(T), square_(square), width_(width) {}

  /// Returns true if the iterates reach the moments to rounding.
  bool find() {
    ring_parameters at(0.0, 0.0, 0.0, -1.0 / width_);
    dual_sums here = of_.evaluate(at);
    double residual = defect(here);
    constexpr int most_iterations = 200;
    for (int iteration = 0; iteration < most_iterations && residual > rounding; ++iteration) {
      ring_parameters next = at;
      dual_sums there = here;
      if (!improve(next, there) || (residual <= close && !(defect(there) < 0.5 * residual))) break;
      at = next;
      here = there;
      residual = defect(here);
    }
    of_.evaluate(at);
    return residual <= close;
  }

 private:
  static constexpr double rounding = 1e-15;  ///< rounding of sums, reached in most cases
  static constexpr double close = 1e-12;  ///< rounding may keep sums of thousands of terms at this distance

  /// Takes one step that reduces the dual or the residual; near the minimum the dual varies by less than its
  /// rounding. If nearly all mass is at few points, some directions change nothing. Steps are then damped by
  /// adding to the diagonal. Returns false if no such step exists.
  bool improve(ring_parameters& at, dual_sums& here) const {
    const double residual = defect(here), before = value(here, at);
    const int halvings = residual <= close ? 1 : 12;
    const double most_damping = residual <= close ? 1e-14 : 1.0;
    for (double damping = 1e-15; damping < most_damping; damping *= 1e3) {
      ring_parameters step = newton_step(here, damping);
      for (int k = 0; k < halvings && step.allFinite(); ++k, step *= 0.5) {
        const ring_parameters next = at + step;
        const dual_sums there = of_.evaluate(next);
        if (!(defect(there) < 0.9 * residual) && !(value(there, next) < before)) continue;
        at = next;
        here = there;
        return true;
      }
    }
    return false;
  }

  double value(const dual_sums& of, const ring_parameters& at) const {
    return of.log_of_sum - 1.5 * T_ * at[3];
  }

  /// Returns the largest defect of momentum and energy. It is relative to sums over all molecules, because
  /// these set the rounding of the given moments.
  double defect(const dual_sums& of) const {
    const double momentum = of.mean.head<3>().cwiseAbs().maxCoeff() / std::sqrt(square_);
    const double energy = 2.0 * std::abs(of.mean[3] - 1.5 * T_) / square_;
    const double largest = std::max(momentum, energy);
    return std::isnan(momentum + energy) ? std::numeric_limits<double>::infinity() : largest;
  }

  /// Computes the step in units in which the diagonal of the Hessian is 1, because its entries differ by
  /// orders of magnitude.
  ring_parameters newton_step(const dual_sums& of, double damping) const {
    ring_parameters gradient = of.mean, unit;
    gradient[3] -= 1.5 * T_;
    for (int k = 0; k < 4; ++k) unit[k] = 1.0 / std::sqrt(std::max(of.covariance(k, k), no_mass));
    Eigen::Matrix4d scaled = unit.asDiagonal() * of.covariance * unit.asDiagonal();
    scaled.diagonal().array() += damping;
    const Eigen::LDLT<Eigen::Matrix4d> factored(scaled);
    const ring_parameters solution = factored.solve(-unit.cwiseProduct(gradient));
    return unit.cwiseProduct(solution);
  }

  factors& of_;
  double T_, square_, width_;
};

bool is_vacuum(const double* omega, double fastest) {
  const double v = std::max(1.0, fastest);
  return std::abs(omega[0]) <= no_mass && std::abs(omega[4]) <= no_mass * v * v &&
         std::all_of(omega + 1, omega + 4, [&](double x) { return std::abs(x) <= no_mass * v; });
}

bool all_finite(const double* omega) {
  return std::all_of(omega, omega + 5, [](double x) { return std::isfinite(x); });
}

}  // namespace

void formula_maxwellian_on_rings(const velocity_grid& grid, const fluid_state& state, double* m) {
  const components at(grid);
  thread_local aligned_vector<double> along, first, second;
  const auto n = static_cast<std::size_t>(grid.lines());
  along.resize(grid.last_line().v().size());
  first.resize(n);
  second.resize(n);
  const double of_one_direction = 1.0 / std::sqrt(2.0 * std::numbers::pi * state.T);
  const double height = state.rho * of_one_direction * of_one_direction * of_one_direction;
  gaussians_on(grid.last_line(), std::array{velocity_rows::gaussian{1.0, state.u[at.axis], state.T}}.data(),
               1, along.data(), 0);
  velocity_rows::gaussian_at(grid.component_of_lines(0), grid.lines(),
                             {height, state.u[at.across[0]], state.T}, first.data());
  velocity_rows::gaussian_at(grid.component_of_lines(1), grid.lines(), {1.0, state.u[at.across[1]], state.T},
                             second.data());
  for (std::size_t l = 0; l < n; ++l) first[l] *= second[l];
  grid_sums::multiply(first.data(), grid.lines(), along.data(), grid.last_line().points(), m);
}

double gap_square_on_rings(const velocity_grid& grid, const fluid_state& state) {
  const components at(grid);
  const double width = std::sqrt(std::max(state.T, 0.0)), u = state.u[at.axis];
  const double across = std::hypot(state.u[at.across[0]], state.u[at.across[1]]) + width;
  const auto& rings = grid.polar().speeds;
  const auto beyond = std::upper_bound(rings.begin(), rings.end(), across) - rings.begin();
  const std::size_t above = std::min(static_cast<std::size_t>(beyond), rings.size() - 1);
  const double gap = above > 0 ? rings[above] - rings[above - 1] : 2.0 * rings[0];
  const double arc = rings[above] * 2.0 * std::numbers::pi / grid.polar().angles;
  const double along = grid.last_line().widest_gap(u - width, u + width);
  const double largest = std::max({gap, arc, along});
  return largest * largest;
}

bool discrete_maxwellian_on_rings(const velocity_grid& grid, const double* omega, double* m) {
  if (!all_finite(omega)) return false;
  if (!(omega[0] > 0.0)) {
    if (!is_vacuum(omega, grid.max())) return false;
    std::fill_n(m, grid.size(), 0.0);
    return true;
  }
  fluid_state state = to_fluid_state(omega, 3);
  // All mass of f ≥ 0 may have one velocity. T is then 0 up to the rounding of sums.
  const double square = 2.0 * omega[4] / omega[0], rounding = 1e-14 * square, coldest = 1e-15 * square;
  if (!std::isfinite(state.T) || !(state.T >= -rounding)) return false;
  state.T = std::max({state.T, coldest, no_mass});
  factors of(grid, state);
  // A narrow Gaussian is 0 far away, where few molecules may be needed. The second start is therefore wide.
  const double narrow = std::max(state.T, 0.1 * gap_square_on_rings(grid, state)),
               wide = 0.25 * grid.max() * grid.max();
  if (!dual_minimum(of, state.T, square, narrow).find() && !dual_minimum(of, state.T, square, wide).find())
    return nonnegative_row(grid, omega, m);
  of.write(m);
  return true;
}

std::string why_unrealizable_on_rings(const velocity_grid& grid, const double* omega) {
  if (!all_finite(omega)) return "a moment is not finite";
  if (!(omega[0] > 0.0))
    return is_vacuum(omega, grid.max()) ? "" : fmt::format("density {:.6g} is not positive", omega[0]);
  const fluid_state state = to_fluid_state(omega, 3);
  if (!(state.T > 0.0)) return fmt::format("temperature {:.6g} is not positive", state.T);
  thread_local aligned_vector<double> row;
  row.resize(static_cast<std::size_t>(grid.size()));
  if (discrete_maxwellian_on_rings(grid, omega, row.data())) return "";
  return fmt::format(
      "no f >= 0 on the {} rings of {} velocities has the temperature {:.6g} at the bulk velocity ({:.6g}, "
      "{:.6g}, {:.6g})",
      grid.polar().rings, grid.polar().angles, state.T, state.u[0], state.u[1], state.u[2]);
}

}  // namespace apsis
