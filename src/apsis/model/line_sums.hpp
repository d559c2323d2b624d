#pragma once

namespace apsis {

/// The loops of line_family over the points of one direction, for the instruction set of this processor. The
/// order of sums does not depend on it. All arrays are padded to whole packets (model/vector_math.hpp).
namespace line_sums {

/// Sums of the weights.
struct values {
  double mass = 0.0,  ///< Σ w
      above = 0.0,    ///< Σ w max(x, 0)
      below = 0.0,    ///< Σ w max(−x, 0)
      energy = 0.0;   ///< Σ w c
};
/// w ← base exp(βx − τc − shift) at n points, at most e^691 base. Values below 1e−300 and the padding become
/// 0. base = nullptr stands for 1. Returns the sums of w.
values weigh(const double* x, const double* c, const double* base, int n, double beta, double tau,
             double shift, double* w);

/// Sums from which the derivatives of `values` with respect to β and τ follow.
struct products {
  double above_x = 0.0,  ///< Σ w max(x, 0) x
      above_c = 0.0,     ///< Σ w max(x, 0) c
      below_x = 0.0,     ///< Σ w max(−x, 0) x
      below_c = 0.0,     ///< Σ w max(−x, 0) c
      cc = 0.0;          ///< Σ w c²
};
/// Returns the sums for the weights w of weigh().
products multiply(const double* x, const double* c, const double* w, int n);

}  // namespace line_sums
}  // namespace apsis
