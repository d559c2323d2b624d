#pragma once

#include <apsis/method/tableau.hpp>

#include <string>
#include <vector>

namespace apsis {

class time_integrator;

/// Execution order of a step, derived once from the zero pattern of the Shu–Osher form. No T(u_j) is ever
/// stored, and as few state-sized buffers as possible are in use.
///
/// As soon as u_j is known, T(u_j) is evaluated once and added to the accumulator of every later stage that
/// uses it. A multiple p_kj u_j alone does not open an accumulator. It waits until some T(u_i) opens that of
/// stage k, or until stage k itself is due. The buffer of a u_j with no other use then becomes the
/// accumulator. u^n is kept until the step is complete, so that a failed step leaves it unchanged.
class schedule {
 public:
  /// Coefficients of a contribution from stage j (0 is u^n) to accumulator k.
  enum class term {
    weight,          ///< α = r_k (j = 0) or p_kj + w_kj, β = Δt w_kj / r on T(u_j)
    minus_explicit,  ///< α = −d_kj/d_jj on the explicit part of u_j, before its stage solve …
    plus_solved,     ///< … and α = +d_kj/d_jj after it: together Δt d_kj Q(u_j)
    collision        ///< β = Δt d_kj on Q(u_j), which is evaluated
  };
  /// Adds α u_j + β T(u_j) (or β Q(u_j)) to one accumulator.
  struct contribution {
    int stage;                ///< k
    int buffer;               ///< buffer of accumulator k
    std::vector<term> terms;  ///< terms whose sums are α and β
    bool fresh;               ///< whether it is the first contribution to k
  };
  /// Functions of a problem, see `problem` and `problem_with_explicit_collision`.
  enum class action { add_transport, add_collision, solve_collision };
  /// A call of such a function for stage j.
  struct instruction {
    action what;                   ///< the function
    int stage;                     ///< j; 0 is u^n
    int buffer;                    ///< buffer of u_j (or its explicit part)
    std::vector<contribution> to;  ///< empty for a stage solve
  };

  /// Builds the schedule. With `embedded`, the last row of m is an embedded solution, and u^{n+1} is the row
  /// before it. The sums of the stages and their order do not depend on this row. The counts below include
  /// it.
  template <class Real>
  explicit schedule(const shu_osher_form<Real>& m, bool embedded = false);

  /// Returns the instructions in execution order.
  const std::vector<instruction>& instructions() const { return instructions_; }
  /// Returns the number of state-sized buffers of a step, including u^n (buffer 0).
  int buffers() const { return buffers_; }
  /// Returns the buffer of u^{n+1}.
  int result_buffer() const { return result_; }
  /// Returns the buffer of the embedded solution; −1 without one.
  int embedded_buffer() const { return embedded_; }
  /// Returns the number of evaluations of T per step.
  int transport_evaluations() const { return transports_; }
  /// Returns the number of explicit evaluations of Q per step.
  int collision_evaluations() const { return collisions_; }
  /// Returns the number of stage solves per step.
  int implicit_solves() const { return solves_; }

 private:
  struct pattern;
  class builder;
  void build(const pattern& p);

  std::vector<instruction> instructions_;
  int buffers_ = 1, result_ = 0, embedded_ = -1, transports_ = 0, collisions_ = 0, solves_ = 0;
};

/// Returns the number of states that a step of an integrator needs, u included: those of its starter and
/// those that it keeps between steps.
int buffers_of(const time_integrator& m);

}  // namespace apsis
