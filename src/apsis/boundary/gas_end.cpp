#include <apsis/boundary/gas_end.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr std::size_t most = 5;  ///< numbers of ω in three dimensions

[[noreturn]] void fail(const std::string& problem, double t) {
  throw numerical_error(problem, {-1, t, -1, std::numeric_limits<double>::quiet_NaN()});
}

}  // namespace

const gas& gas_of(const model& equation, const std::string& boundary_name) {
  if (const auto* found = equation.as_gas()) return found->molecules();
  throw input_error(fmt::format(
      "boundary '{}' cannot be used (the model is no gas with density, velocity and temperature); "
      "choose another kind, see: apsis list boundaries",
      boundary_name));
}

gas_end::gas_end(const model& equation, std::string boundary_name)
    : molecules_(gas_of(equation, boundary_name)),
      name_(std::move(boundary_name)),
      gamma_((molecules_.degrees_of_freedom() + 2.0) / molecules_.degrees_of_freedom()) {}

double gas_end::sound(double T) const {
  return std::sqrt(gamma_ * T);
}

/// The ghost averages a₁, a₂, a₃ of a quadratic give the value (11 a₁ − 7 a₂ + 2 a₃)/6 at the face. Next to a
/// vacuum, for example, this value may be no state of a gas. The nonnegative part of the first ghost cell
/// then replaces it.
fluid_state gas_end::state_at_face(std::span<const double* const> ghosts, double* row) const {
  std::array<double, most> omega{};
  const auto moments_of = [&](std::size_t ghost) {
    std::array<double, most> of{};
    molecules_.moments(ghosts[ghost], 0, 1, of.data());
    return of;
  };
  if (ghosts.size() >= 3) {
    const auto a = moments_of(0), b = moments_of(1), c = moments_of(2);
    for (std::size_t k = 0; k < omega.size(); ++k) omega[k] = (11.0 * a[k] - 7.0 * b[k] + 2.0 * c[k]) / 6.0;
    if (const fluid_state state = molecules_.state(omega.data()); state.admissible()) return state;
  }
  for (int k = 0; k < molecules_.velocities().components(); ++k) row[k] = std::max(ghosts[0][k], 0.0);
  molecules_.moments(row, 0, 1, omega.data());
  return molecules_.state(omega.data());
}

void gas_end::incoming_given_outgoing(const face& where, double t, const position& at, const double* outgoing,
                                      std::span<const double* const> ghosts, double* values) const {
  const fluid_state inside = state_at_face(ghosts, values);
  const fluid_state state = outside(inside, where, t, at);
  std::array<double, most> omega{};
  const int d = molecules_.dimensions();
  double square = 0.0;
  omega[0] = state.rho;
  for (int k = 0; k < d; ++k) {
    omega[static_cast<std::size_t>(k) + 1] = state.rho * state.u[k];
    square += state.u[k] * state.u[k];
  }
  omega[static_cast<std::size_t>(d) + 1] =
      0.5 * state.rho * (square + molecules_.degrees_of_freedom() * state.T);
  if (state.admissible() && molecules_.equilibrium(omega.data(), values))
    return adjust(where, t, at, outgoing, values);
  if (!state.admissible() || !(outward(state, where) > sound(state.T)))
    fail(fmt::format(
             "no Maxwellian has the state outside of a boundary '{}' (density {:.6g}, normal velocity "
             "{:.6g}, temperature {:.6g}{}); change its values, or use more velocity.points or a larger "
             "velocity.max",
             name_, state.rho, outward(state, where), state.T,
             state.admissible() ? ": " + molecules_.why_inadmissible(omega.data()) : ""),
         t);
  // The gas leaves faster than the velocities of the grid, so that nothing enters.
  std::fill_n(values, molecules_.velocities().components(), 0.0);
}

}  // namespace apsis
