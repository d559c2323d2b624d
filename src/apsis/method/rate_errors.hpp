#pragma once

#include <apsis/method/intermediate_regime.hpp>
#include <apsis/method/method.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace apsis {

/// Relative errors of the O(ε) terms of a method at finite z = CΔt/ε (docs/plateaus.md).
struct rate_errors {
  double flux = 0.0,  ///< flux(z) − 1: of the term −ℛT′(E) D of the moments
      last = 0.0,     ///< last(z) − 1: of the deviation D from equilibrium in u^{n+1}
      layer = 0.0;    ///< λ(z)/(1 − R(−z)) − 1/z: of the time integral of the initial layer over D₀ Δt
};

/// Computes the errors of a method of one step at z > 0. Stages with exact collisions relax by e^{−d_i z}.
/// Errors of explicit methods are infinite where z exceeds their stability limit.
rate_errors rate_errors_at(const method& m, double z);

/// Errors of the O(ε) terms for every z, as polynomials of s = 1/(1 + z). Repeated implicit Euler solves
/// multiply a deviation by s. A combination of them therefore applies such a polynomial at every point of
/// space, with the z of that point:
///   flux(z) − 1 ≈ (1 − s) Σ_k flux_k s^k,    last likewise,    layer ≈ Σ_k layer_k s^k.
struct rate_response {
  static constexpr std::size_t terms = 9;  ///< number of coefficients
  std::array<double, terms> flux{};        ///< flux_k
  std::array<double, terms> last{};        ///< last_k
  std::array<double, terms> layer{};       ///< layer_k
  /// lim (last(z) − 1)/z for z → ∞, nonzero if the result is not relaxed. `last` does not contain this
  /// growth.
  double last_growth = 0.0;

  /// Returns the largest |Σ_k c_k s^k| (1 − s) over 0 ≤ s ≤ 1.
  static double largest(const std::array<double, terms>& c);
};

/// Interpolates errors at Chebyshev nodes of s, one of them s = 0, so that plateaus are exact. Returns
/// nothing if an error is infinite or NaN, as those of explicit methods are.
std::optional<rate_response> fit_rate_response(const std::function<rate_errors(double z)>& errors);

/// Returns the response of a method of one step; nothing for explicit and implicit-only methods.
std::optional<rate_response> compute_rate_response(const method& m);

/// Returns the response of the integrator called `name`; nothing for explicit and implicit-only methods.
/// Throws like find_integrator().
std::optional<rate_response> compute_rate_response(const std::string& name);

}  // namespace apsis
