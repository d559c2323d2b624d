#pragma once

#include "contest.hpp"

#include <apsis/method/method.hpp>
#include <apsis/verify/ode_model.hpp>

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace apsis::bench::peers {

/// A stiff system of two unknowns, u' = T(u) + C(ω)(E(ω) − u)/ε with ω = u1, from t = 0 to 1, in the form
/// that each contestant needs. Dimensionless. T and Q do not depend on t explicitly.
class stiff_task {
 public:
  using state = ode_state<double>;

  virtual ~stiff_task() = default;
  virtual state initial() const = 0;
  virtual state transport(const state& u) const = 0;  ///< T(u)
  virtual state collision(const state& u) const = 0;  ///< Q(u)/ε
  virtual Eigen::Matrix2d transport_jacobian(const state& u) const = 0;
  virtual Eigen::Matrix2d collision_jacobian(const state& u) const = 0;

  /// Runs `steps` equal steps of an integrator of integrators.hpp. With a `growth` other than 0, the first
  /// step is divided into steps that resolve the initial layer; their times grow by this factor. Seconds are
  /// those of one of many integrations, without the construction of the stepper.
  virtual outcome run(const std::string& name, long steps, int growth) const = 0;
  /// Runs a method with an embedded solution to a tolerance of the steps, relative to u in the 2-norm.
  virtual outcome run_to_tolerance(const method& m, double tolerance) const = 0;

  double epsilon() const { return epsilon_; }
  /// Returns |Δu1| + |Δu2| at t = 1.
  double error(const state& u) const { return ode_distance(u, exact_); }

 protected:
  stiff_task(double epsilon, ode_state<long double> exact) : epsilon_(epsilon), exact_(exact) {}

 private:
  double epsilon_;
  ode_state<long double> exact_;
};

/// Returns the ODE model of the paper (apsis/verify/ode_model.hpp); u2 is initially out of equilibrium.
std::unique_ptr<stiff_task> make_ode_model(double epsilon);
/// Returns Kaps' problem in the variables u1 = y2, u2 = y1: u1' = u2 − u1 − u1², u2' = −2u2 + (u1² −
/// u2)/ε from (1, 1). The solution is u1 = e^{−t}, u2 = u1² for every ε (Kaps, Rentrop, Numer. Math. 33
/// (1979) 55–68).
std::unique_ptr<stiff_task> make_kaps(double epsilon);
/// Returns Prothero and Robinson's problem y' = φ'(t) + (φ(t) − y)/ε with φ = sin(π/4 + t) and time as u1,
/// from y = φ(0) (Prothero, Robinson, Math. Comp. 28 (1974) 145–162).
std::unique_ptr<stiff_task> make_prothero_robinson(double epsilon);

/// Returns the seconds per call of `body`, averaged over enough calls for the resolution of the clock.
double seconds_per_call(const std::function<void()>& body);

}  // namespace apsis::bench::peers
