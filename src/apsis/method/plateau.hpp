#pragma once

#include <apsis/method/intermediate_regime.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace apsis {

/// Bounds of |last(z) − 1| and |flux(z) − 1| (at_finite_rate) for z = CΔt/ε ≥ 1:
///   |last(z) − 1| ≤ last (z/(1+z))³ + last_band z³/(1+z)⁴,    flux likewise.
/// The first term is the plateau of a method, the second the remainder where ε ~ Δt (docs/plateaus.md).
struct plateau_bounds {
  double last = 0.0,    ///< relative error of the deviation from equilibrium in u^{n+1}, where ε ≪ Δt
      last_band = 0.0,  ///< the same where ε ~ Δt
      flux = 0.0,       ///< relative error of the deviation that enters the transport, where ε ≪ Δt
      flux_band = 0.0;  ///< the same where ε ~ Δt
};

/// Computes the bounds from 20 samples per decade of 1 ≤ z ≤ 10⁵; the first terms are the values at z = 10⁵.
/// The bounds are +infinity if the stage equations have no solution.
template <class Real>
plateau_bounds compute_plateau_bounds(const butcher_form<Real>& b) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto defect = [&](const Real& x) {
    const double found = std::abs(static_cast<double>(x) - 1.0);
    return std::isnan(found) ? infinity : found;
  };
  const auto defects = [&](double z) {
    const auto at = at_finite_rate(b, Real(z));
    return finite_rate<double>{defect(at.flux), defect(at.last)};
  };
  const auto limit = defects(1e5);
  plateau_bounds bounds{limit.last, 0.0, limit.flux, 0.0};
  for (int k = 0; k <= 100; ++k) {
    const double z = std::pow(10.0, k / 20.0), share = std::pow(z / (1.0 + z), 3);
    const auto here = defects(z);
    const auto rest = [&](double of, double plateau) {
      return of < infinity ? std::max(of / share - plateau, 0.0) * (1.0 + z) : infinity;
    };
    bounds.last_band = std::max(bounds.last_band, rest(here.last, limit.last));
    bounds.flux_band = std::max(bounds.flux_band, rest(here.flux, limit.flux));
  }
  return bounds;
}

}  // namespace apsis
