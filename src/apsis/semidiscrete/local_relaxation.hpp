#pragma once

#include <apsis/core/aligned.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/relaxation_weights.hpp>
#include <apsis/model/model.hpp>

#include <limits>

namespace apsis {

/// Moments, rate and equilibrium of one point, in scratch space that is reused from point to point.
class local_relaxation {
 public:
  void attach(const relaxation_model& equation) {
    equation_ = &equation;
    omega_.resize(static_cast<std::size_t>(equation.moment_count()));
    equilibrium_.resize(static_cast<std::size_t>(equation.components()));
  }

  const double* equilibrium() const { return equilibrium_.data(); }

  /// E(ℛu) into equilibrium(), and the weights of the stage solve. `cell` is for the message only.
  relaxation_weights<double> prepare(const double* u, double a, double b, double epsilon, int cell) {
    find_equilibrium(u, cell);
    return relax_weights(a, b, equation_->rate(omega_.data()), epsilon);
  }

  /// C(ℛu).
  double rate(const double* u) {
    equation_->moments(u, omega_.data());
    return equation_->rate(omega_.data());
  }

  /// ε/C; +infinity where it is 0 or nothing relaxes.
  double relaxation_time(const double* u, double epsilon) {
    const double width = epsilon / rate(u);
    return width > 0.0 ? width : std::numeric_limits<double>::infinity();
  }

  /// E(ℛu) into equilibrium(), and C/ε.
  double strength(const double* u, double epsilon, int cell) {
    find_equilibrium(u, cell);
    if (!(epsilon > 0.0))
      throw numerical_error(
          "Q/epsilon does not exist for epsilon = 0 (the method evaluates it explicitly); choose an "
          "implicit or IMEX method",
          {-1, site_unknown, cell, epsilon});
    return equation_->rate(omega_.data()) / epsilon;
  }

 private:
  static constexpr double site_unknown = std::numeric_limits<double>::quiet_NaN();

  void find_equilibrium(const double* u, int cell) {
    equation_->moments(u, omega_.data());
    if (!equation_->equilibrium(omega_.data(), equilibrium_.data()))
      throw numerical_error("no local equilibrium (" + equation_->why_inadmissible(omega_.data()) +
                                "); use the positivity limiter or a smaller step",
                            {-1, site_unknown, cell, omega_[0]});
  }

  const relaxation_model* equation_ = nullptr;
  aligned_vector<double> omega_, equilibrium_;
};

}  // namespace apsis
