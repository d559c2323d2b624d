#pragma once

#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/semidiscrete_problem.hpp>

#include <span>
#include <vector>

namespace apsis::bench::peers {

/// A relaxation on point values with the exact solution of its collision, for exponential methods: in every
/// cell f ← e^{−z} f + (1 − e^{−z}) E, z = sC/ε. All other functions are those of the semidiscrete problem.
class kinetic_flow {
 public:
  using state = field;
  using real = double;

  /// `rates`: 1/ε of every cell. All arguments must outlive this object.
  kinetic_flow(semidiscrete_problem& problem, const relaxation_model& equation,
               const std::vector<double>& rates);

  void add_transport(double t, const field& u, std::span<const target<field, double>> targets) {
    problem_.add_transport(t, u, targets);
  }
  void solve_collision(double t, double a, double b, field& u) { problem_.solve_collision(t, a, b, u); }
  double forward_euler_step(double t, const field& u) const { return problem_.forward_euler_step(t, u); }
  double relaxation_time(double t, const field& u) const { return problem_.relaxation_time(t, u); }
  /// Throws numerical_error where there is no equilibrium.
  void advance_collision(double t, double s, field& u);

 private:
  static constexpr int batch = 8;  ///< rows whose moments and equilibria are computed together
  semidiscrete_problem& problem_;
  const relaxation_model& equation_;
  const std::vector<double>& rates_;
  std::vector<double> omega_;
  field equilibria_;
};

}  // namespace apsis::bench::peers
