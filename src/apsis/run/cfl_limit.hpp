#pragma once

#include <apsis/method/amplification.hpp>
#include <apsis/scheme/reconstruction.hpp>

#include <complex>
#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// Largest growth that counts as stable, for each cell that a wave crosses: a factor e in a thousand cells.
/// Methods of order 2 amplify every resolved wave by O((Δt/Δx)³ θ⁴) per cell. Fifth-order reconstructions
/// damp it by only θ⁶/60. Without an allowance, no step would be stable.
inline constexpr double growth_per_cell = 1e-3;

/// Returns the coefficients c_k of the right edge value of a cell, Σ_k c_k u_{i+k}, for k = −g … g with g =
/// ghost_width(). The reconstruction is linearized at constant data, where WENO has its linear weights.
std::vector<double> linear_edge(const reconstruction& scheme);

/// Returns Δx λ(θ)/v for the eigenvalue λ(θ) of the upwind difference −v (û_{i+1/2} − û_{i−1/2})/Δx, v > 0,
/// on the wave exp(iθx/Δx).
std::complex<double> transport_symbol(const std::vector<double>& edge, double theta);

/// Returns the linear stability limit of an integrator with a reconstruction, as a CFL number. It is the
/// largest ν up to which no periodic wave of u_t + v u_x = −u/ε grows by more than growth_per_cell, with Δt =
/// νΔx/|v|. The limit covers every wavenumber and every Δt/ε in [0, ∞]; for explicit methods, Δt/ε = 0 only.
/// In several directions ν is Σ_k |v_k| Δt/Δx_k: transport_symbol() encloses a convex region, and the maximum
/// of |R(z, w)| over it lies on its boundary. Returns infinity without transport, and for limits above 100.
double cfl_limit(const amplification& growth, const reconstruction& scheme);

/// Returns the limits with all reconstructions, by name.
std::vector<std::pair<std::string, double>> cfl_limits(const amplification& growth);

/// Returns cfl_limits() as text, such as "1 with upwind1, …". Each limit appears once, with the names of
/// its reconstructions.
std::string cfl_text(const std::vector<std::pair<std::string, double>>& limits);

}  // namespace apsis
