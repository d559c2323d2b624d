#pragma once

#include <apsis/method/amplification.hpp>
#include <apsis/scheme/reconstruction.hpp>

#include <complex>
#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// Largest growth of a wave while it crosses one cell that counts as stable: a factor e in a thousand cells.
/// Methods of order 2 amplify every resolved wave by O((Δt/Δx)³ θ⁴) per cell, which fifth-order
/// reconstructions damp by θ⁶/60 only, so that without an allowance no step would be stable.
inline constexpr double growth_per_cell = 1e-3;

/// Coefficients c_k of the right edge of a cell, Σ_k c_k u_{i+k}, k = −g … g with g = ghost_width(), of a
/// reconstruction linearized at constant data; WENO then has its linear weights.
std::vector<double> linear_edge(const reconstruction& scheme);

/// Δx λ(θ)/v of the upwind difference −v (û_{i+1/2} − û_{i−1/2})/Δx, v > 0, on waves exp(iθx/Δx).
std::complex<double> transport_symbol(const std::vector<double>& edge, double theta);

/// Returns the linear stability limit of an integrator with a reconstruction, in a CFL number: the largest ν
/// up to which no periodic wave of u_t + v u_x = −u/ε, Δt = νΔx/|v|, grows by more than growth_per_cell, for
/// every wavenumber and every Δt/ε in [0, ∞]; with Δt/ε = 0 alone for explicit methods. In several directions
/// ν is Σ_k |v_k| Δt/Δx_k: transport_symbol() encloses a convex region, and the maximum of |R(z, w)| over it
/// lies on its boundary. Infinite without transport, and above 100.
double cfl_limit(const amplification& growth, const reconstruction& scheme);

/// Returns the limits with all reconstructions, by name.
std::vector<std::pair<std::string, double>> cfl_limits(const amplification& growth);

/// Returns "name limit" of cfl_limits(), reconstructions with equal limits joined: "1 with upwind1, …".
std::string cfl_text(const std::vector<std::pair<std::string, double>>& limits);

}  // namespace apsis
