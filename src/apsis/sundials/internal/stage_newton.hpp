#pragma once

#include "linear_systems.hpp"

#include <string>

namespace apsis::sundials {

/// Accuracy of stage solves, and constraints on their states.
struct stage_accuracy {
  double relative = 0.0;
  nvector absolute;     ///< of each unknown; without it stages are solved to rounding errors
  nvector constraints;  ///< ±1, ±2 or 0 of each unknown, as ARKODE defines them; none without it
};

/// Sets w_i ← 1/(relative |y_i| + absolute_i).
void set_weights(double relative, N_Vector absolute, N_Vector y, N_Vector w);
/// Whether y satisfies constraints; true without them. `mask` is overwritten.
bool satisfies(const nvector& constraints, N_Vector y, N_Vector mask);

/// Newton's method for stages v = u + a Q(t, v) + b (J Q(t, v) + ∂Q/∂t), J = ∂Q/∂y. Its matrix contains
/// second derivatives of Q only if the iteration converges slowly without them. A step is halved until the
/// next step or the residual is smaller (the natural monotonicity test: P. Deuflhard, Newton Methods for
/// Nonlinear Problems, 2004, section 3.3). Far from equilibrium a stage starts from the solution of v = u +
/// √|b| Q(t, v). The iteration ends when the error that the rate of convergence predicts is below a share of
/// the tolerance.
class stage_newton {
 public:
  /// Stores references; vectors are made like `like`.
  stage_newton(functions& of, const stage_accuracy& accuracy, const nvector& like);

  /// Solves a stage with the explicit part u, and writes v to u. `timed`: with ∂Q/∂t. Throws numerical_error
  /// if a callback rejects a state or if Newton's method fails, callback_error if a callback fails; u is then
  /// unchanged.
  void solve(double t, bool timed, double a, double b, nvector& u);

 private:
  struct stage {
    double t, a, b;
    bool timed;
    N_Vector u;
  };
  /// A state with k = Q, the residual r = u + a k + b (J k + ∂Q/∂t) − v, and the correction δ.
  struct iterate {
    nvector v, k, jk, r, delta;
    double residual = 0.0, size = 0.0;  ///< norms of r and δ, that of δ in units of the accuracy
    bool admissible = true;
  };

  bool evaluate(const stage& s, iterate& at);
  void add_time_derivative(const stage& s, iterate& at);
  void correct(const stage& s, iterate& at, double expected);
  void correct_again(const stage& s);
  bool advance(const stage& s);
  void finish(const stage& s);
  void start_at(const stage& s);
  void find_root(const stage& s);
  bool is_far_from_equilibrium(const stage& s) const;
  bool find_root_from_implicit_euler(const stage& s);
  bool is_small(const iterate& at) const;
  bool is_done(double before) const;
  void prepare(const stage& s, bool fresh);
  [[noreturn]] void fail(const stage& s, const std::string& does) const;
  void require(int returned, const char* problem);

  functions& of_;
  const stage_accuracy& accuracy_;
  linear_systems systems_;
  iterate now_, next_;
  nvector weights_, work_;
  bool curved_ = false;                    ///< whether this stage needs second derivatives
  double unit_ = 1.0;                      ///< the norm of a correction of size 1
  double noise_ = 1.0;                     ///< the largest size that rounding errors may have
  double known_a_ = -1.0, known_b_ = 1.0;  ///< of the last preconditioner
  int age_ = 0;                            ///< stages since the last new Jacobian; 0 before the first
  bool fresh_ = false;                     ///< whether the preconditioner is of the present iterate
};

}  // namespace apsis::sundials
