#pragma once

#include <cstddef>
#include <vector>

namespace apsis::bench::plain {

/// Coefficients of a method, stage by stage: P and W row by row (s × s), d, ddot and r of
///   u_i = r_i u^n + Σ_j p_ij u_j + Σ_j w_ij (u_j + (Δt/r) T(u_j)) + Δt d_i Q(u_i) + Δt² ddot_i Q̇(u_i).
struct method {
  int stages = 0;
  std::vector<double> P, W, d, ddot;
  double r = 1.0;
};

/// f_t + v f_x = (M[f] − f)/ε(x), periodic in x, directly as in the literature: loops over cells and
/// velocities and arrays of doubles. Finite volumes with WENO5-Z (Borges et al. 2008), the positivity limiter
/// of Zhang & Shu (2010), upwind fluxes, collisions at three Gauss points of the quartic of every cell, and
/// stages with T(u_j) stored. Baseline for the library, with which it shares no code.
class bgk {
 public:
  struct mesh {
    int cells;
    double dx;
    std::vector<double> v;        ///< velocities, equally spaced
    std::vector<double> epsilon;  ///< three per cell, at the Gauss points from left to right
  };

  bgk(mesh space, method scheme);

  /// Advances f[cell · velocities + j] by one step.
  void step(double dt, std::vector<double>& f);

 private:
  std::size_t at(int cell, int j) const {
    return static_cast<std::size_t>(cell) * static_cast<std::size_t>(velocities_) +
           static_cast<std::size_t>(j);
  }
  const double* neighbour(const std::vector<double>& f, int cell) const;

  /// Computes left_ and right_, the edge values of every cell.
  void reconstruct(const std::vector<double>& f);
  void limit(const std::vector<double>& f);
  void transport(const std::vector<double>& f, std::vector<double>& out);
  void collide(double a, double b, std::vector<double>& f);
  void gauss_values(const std::vector<double>& f, int cell);
  void maxwellian(const std::vector<double>& f);
  void sum_stage(int i, double dt, const std::vector<double>& f, std::vector<double>& u) const;

  mesh mesh_;
  method method_;
  int velocities_;
  double dv_;
  std::vector<std::vector<double>> stages_, transports_;
  std::vector<bool> transported_;  ///< whether T of the stage enters a later one
  std::vector<double> left_, right_, result_, maxwellian_;
  std::vector<double> gauss_[3];
};

}  // namespace apsis::bench::plain
