#pragma once

#include <apsis/scheme/limiter.hpp>
#include <apsis/scheme/reconstruction.hpp>

#include <algorithm>
#include <memory>

namespace apsis {

/// A reconstruction scheme with the positivity limiter of its edge values.
struct limited_reconstruction {
  /// The values that the positivity limiter changes.
  enum class limits {
    nothing,  ///< no limiter
    edges,    ///< scales edge values of cell averages towards the average (Zhang & Shu)
    fluxes    ///< blends fluxes of point values with first-order upwind (Zalesak, Xu)
  };

  std::shared_ptr<const reconstruction> scheme;  ///< reconstruction of edge values; null without space
  limits limited = limits::nothing;              ///< what the limiter changes

  /// Returns true if there is a limiter.
  bool keeps_sign() const { return limited != limits::nothing; }
  /// Returns true if edge values are limited; both edges of a cell are then needed.
  bool limits_edges() const { return limited == limits::edges; }
  /// Returns true if fluxes are limited.
  bool limits_fluxes() const { return limited == limits::fluxes; }
  /// Returns the number of cells beyond a block whose edges are needed: one for the flux, and another one for
  /// the limiter of fluxes.
  int halo() const { return limits_fluxes() ? 2 : 1; }
  /// Returns the number of cells on each side that the edges and the limiter of a cell depend on.
  int reach() const { return std::max(scheme->ghost_width(), halo()); }
  /// Returns the number of ghost rows that a sweep reads beyond the end of a segment.
  int ghosts() const { return halo() + reach(); }
  /// Returns κ of Δt_FE = κ / max Σ_k |v_k|/Δx_k: 1/12 with limited edges (Zhang & Shu 2010), else 1.
  /// Up to this step limited fluxes preserve positivity. First-order upwind also preserves total
  /// variation and entropy.
  double kappa() const { return limits_edges() ? limiter::end_weight : 1.0; }
};

}  // namespace apsis
