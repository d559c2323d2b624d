#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/core/relaxation_weights.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/model/model.hpp>
#include <apsis/phase/field.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace apsis {

/// Moments, rates and equilibria of some points, in scratch space that is used again and again. All points
/// pass through one step before any goes on to the next: each step is a chain of operations that wait for
/// each other, and the processor works on those of several points at once.
class local_relaxation {
 public:
  /// For at most `points` points at once. `limited`: nonnegative data stay so in steps within r Δt_FE, which
  /// is for the message only.
  void attach(const relaxation_model& equation, int points, bool limited = false) {
    equation_ = &equation;
    limited_ = limited;
    moments_ = equation.moment_count();
    stride_ = field::padded(equation.components());
    const auto n = static_cast<std::size_t>(points);
    omega_.resize(n * static_cast<std::size_t>(moments_));
    for (auto* numbers : {&rates_, &stay_, &relax_}) numbers->resize(n);
    // Padded with zeros like the rows of a field. Of another model nothing may be left there.
    if (equilibria_.size() != n * static_cast<std::size_t>(stride_))
      equilibria_.assign(n * static_cast<std::size_t>(stride_), 0.0);
  }

  /// E(ℛu) of the points whose rows are `pitch` numbers apart. Point p belongs to cell first_cell + p /
  /// per_cell, which is for the message only.
  void find_equilibria(const double* u, std::ptrdiff_t pitch, int points, int first_cell, int per_cell = 1) {
    const profile::section timed(kernel::equilibria,
                                 static_cast<double>(points) * static_cast<double>(stride_),
                                 {equation_->operations_of_equilibrium(), 0.0});
    equation_->moments_of_rows(u, pitch, points, omega(0));
    const int p = equation_->equilibria(omega(0), points, equilibrium_row(0), stride_);
    if (p < points)
      throw numerical_error(
          "no local equilibrium (" + equation_->why_inadmissible(omega(p)) + "); " + advice(),
          {-1, site_unknown, first_cell + p / per_cell, *omega(p)});
  }

  /// The row that find_equilibria() left for point p, padded with zeros like the rows of a field.
  const double* equilibrium(int p) const { return equilibria_.data() + p * stride_; }

  /// Weights of the stage solves of points that have their equilibria, ε being that of each.
  void find_weights(double a, double b, const double* epsilon, int points) {
    double *rates = rates_.data(), *stay = stay_.data(), *relax = relax_.data();
    for (int p = 0; p < points; ++p) rates[p] = equation_->rate(omega(p));
#pragma omp simd
    for (int p = 0; p < points; ++p) {
      const auto weights = relax_weights(a, b, rates[p], epsilon[p]);
      stay[p] = weights.stay;
      relax[p] = weights.relax;
    }
  }
  /// What find_weights() left for point p.
  relaxation_weights<double> weights(int p) const {
    const auto k = static_cast<std::size_t>(p);
    return {stay_[k], relax_[k]};
  }

  /// C/ε of such a point.
  double strength(int p, double epsilon, int cell) const {
    if (!(epsilon > 0.0))
      throw numerical_error(
          "Q/epsilon does not exist for epsilon = 0 (the method evaluates it explicitly); choose an "
          "implicit or IMEX method",
          {-1, site_unknown, cell, epsilon});
    return equation_->rate(omega(p)) / epsilon;
  }

  /// C(ℛu).
  double rate(const double* u) {
    equation_->moments(u, omega(0));
    return equation_->rate(omega(0));
  }

  /// ε/C; +infinity where it is 0 or nothing relaxes.
  double relaxation_time(const double* u, double epsilon) {
    const double width = epsilon / rate(u);
    return width > 0.0 ? width : std::numeric_limits<double>::infinity();
  }

 private:
  static constexpr double site_unknown = std::numeric_limits<double>::quiet_NaN();

  /// Moments of nonnegative rows have an equilibrium.
  const char* advice() const {
    if (!equation_->positive()) return "use a smaller step";
    return limited_ ? "use steps within r dt_FE (time.safety = 1, and a method with r > 0), which keep all "
                      "values nonnegative"
                    : "use the positivity limiter or a smaller step";
  }

  double* omega(int p) { return omega_.data() + p * moments_; }
  const double* omega(int p) const { return omega_.data() + p * moments_; }
  double* equilibrium_row(int p) { return equilibria_.data() + p * stride_; }

  const relaxation_model* equation_ = nullptr;
  bool limited_ = false;
  std::ptrdiff_t moments_ = 0, stride_ = 0;
  aligned_vector<double> omega_, equilibria_, rates_, stay_, relax_;
};

/// Points whose equilibria, and as many rows besides, fit into half of a first-level cache of 32 KiB.
inline int points_at_once(int width) {
  return std::clamp(1024 / std::max(width, 1), 2, 64);
}

}  // namespace apsis
