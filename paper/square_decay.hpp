#pragma once

#include <apsis/method/certificate.hpp>

#include <functional>
#include <string>
#include <vector>

namespace apsis::paper {

/// Returns the names of the methods of the catalogue whose certificate satisfies a condition.
std::vector<std::string> methods_where(const std::function<bool(const certificate&)>& condition);

/// Returns the implicit methods that are strong stability preserving for every step.
std::vector<std::string> unconditional_methods();

/// A run of u' = −10u², u(0) = 10 (paper, numerical tests of the implicit methods). Dimensionless.
struct decay_run {
  std::vector<double> t,   ///< times of u
      u;                   ///< all steps until a stage equation has no root, including the initial state
  bool solvable = true;    ///< every stage equation has a root
  bool positive = true;    ///< every stage and every step is > 0
  bool decreasing = true;  ///< u^{n+1} < u^n at every step

  /// Whether the run behaves like the exact solution: it exists, is positive and decreases.
  bool qualitatively_right() const { return solvable && positive && decreasing; }
};

/// Takes `steps` steps of length dt by the production stepper. Newton's method solves the stages, which may
/// be negative.
decay_run square_decay(const std::string& method, double dt, int steps);

/// Returns the exact solution 1/(1/10 + 10 t).
double square_decay_exact(double t);

/// Returns |u(2) − 1/20.1| after `steps` equal steps in long double, which orders above three require.
double square_decay_error(const std::string& method, long steps);

}  // namespace apsis::paper
