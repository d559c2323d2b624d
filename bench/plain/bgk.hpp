#pragma once

#include <memory>
#include <vector>

namespace apsis::bench::plain {

/// Coefficients of a method, stage by stage: P and W row by row (s × s), d, ddot and r of
///   u_i = r_i u^n + Σ_j p_ij u_j + Σ_j w_ij (u_j + (Δt/r) T(u_j)) + Δt d_i Q(u_i) + Δt² ddot_i Q̇(u_i).
struct method {
  int stages = 0;
  std::vector<double> P, W, d, ddot;
  double r = 1.0;
};

/// A solver of f_t + v f_x = (M[f] − f)/ε(x), periodic in x. It follows the literature directly, with loops
/// over cells and velocities on arrays of doubles. It has finite volumes with WENO5-Z (Borges et al. 2008),
/// the positivity limiter of Zhang & Shu (2010) and upwind fluxes. Collisions act at three Gauss points of
/// the quartic of every cell, and T(u_j) of every stage is stored. It is a baseline for the library, with
/// which it shares no code.
class bgk {
 public:
  struct mesh {
    int cells;
    double dx;
    std::vector<double> v;        ///< velocities, equally spaced
    std::vector<double> epsilon;  ///< three per cell, at the Gauss points from left to right
  };

  virtual ~bgk() = default;

  /// Advances f[cell · velocities + j] by one step.
  virtual void step(double dt, std::vector<double>& f) = 0;
};

/// Returns the solver, compiled with the flags of the library's kernels.
std::unique_ptr<bgk> make_bgk(bgk::mesh space, method scheme);
/// Returns the solver, compiled with -O3 -march=native -ffast-math: for this processor only, and without the
/// guarantees of IEEE 754.
std::unique_ptr<bgk> make_native_bgk(bgk::mesh space, method scheme);

}  // namespace apsis::bench::plain
