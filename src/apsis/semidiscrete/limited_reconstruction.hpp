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

  /// Whether there is a limiter.
  bool keeps_sign() const { return limited != limits::nothing; }
  /// Whether edge values are limited; then both edges of a cell are needed.
  bool limits_edges() const { return limited == limits::edges; }
  /// Whether fluxes are limited.
  bool limits_fluxes() const { return limited == limits::fluxes; }
  /// Returns the number of cells beyond a block whose edges are needed: one for the flux, one more for its
  /// limiter.
  int halo() const { return limits_fluxes() ? 2 : 1; }
  /// Returns the number of cells on either side on which edges and limiter of a cell depend.
  int reach() const { return std::max(scheme->ghost_width(), halo()); }
  /// Returns the number of ghost rows that a sweep reads beyond the end of a segment.
  int ghosts() const { return halo() + reach(); }
  /// Returns κ of Δt_FE = κ / max Σ_k |v_k|/Δx_k: 1/12 with limited edges (Zhang & Shu 2010), else 1, up to
  /// which limited fluxes keep positivity, and first-order upwind also total variation and entropy.
  double kappa() const { return limits_edges() ? limiter::end_weight : 1.0; }
};

}  // namespace apsis
