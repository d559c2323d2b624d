#pragma once

#include <functional>
#include <span>
#include <vector>

#include <paper/limit_equations.hpp>

namespace apsis::paper {

/// The solution of a limit system for smooth data on a periodic interval, in double precision as long as it
/// is smooth. It is computed by Fourier collocation in space, whose error decreases faster than any power of
/// 1/points, and by the classical Runge–Kutta method in time. It is independent of the schemes that are
/// compared with it.
class fourier_solution {
 public:
  /// Computes the solution from initial data on [a, b] to t = end. It has an odd number of collocation points
  /// and takes `steps` steps. The function `initial` sets ω at x. Systems without space have one point.
  /// Throws input_error for an even number of points.
  fourier_solution(const limit_equations& system, double a, double b, int points,
                   const std::function<void(double, std::span<double>)>& initial, double end, int steps);

  /// Returns ω_k at x.
  double value(int k, double x) const { return average(k, x, 0.0); }
  /// Returns the average of ω_k over [x − h/2, x + h/2]; the value at x for h = 0.
  double average(int k, double x, double h) const;
  /// Returns the size of the highest Fourier modes relative to the largest, a measure of the resolution.
  double resolution() const;

 private:
  void slope(const std::vector<double>& omega, std::vector<double>& change) const;
  void transform(const std::vector<double>& omega);
  std::size_t at(int point, int k) const {
    return static_cast<std::size_t>(point) * static_cast<std::size_t>(unknowns_) +
           static_cast<std::size_t>(k);
  }

  limit_equations system_;
  double a_, length_;
  int points_, unknowns_;
  std::vector<double> derivative_;     ///< weights of the derivative by the distance of two points,
                                       ///< points_ entries
  std::vector<double> cosine_, sine_;  ///< [mode][unknown]
};

}  // namespace apsis::paper
