#pragma once

#include <apsis/method/tableau.hpp>

#include <string>
#include <vector>

namespace apsis {

/// The order in which a step of a method is carried out, made once from the zero pattern of its Shu–Osher
/// form, so that no T(u_j) is ever stored and as few state-sized buffers as possible are alive.
///
/// Scatter form: as soon as u_j is known, T(u_j) is evaluated once and added to the accumulator of every
/// later stage that uses it. A multiple p_kj u_j alone does not open an accumulator: it waits until stage k
/// is opened by some T(u_i) (or by its own turn), and then the buffer of a u_j that nobody else waits for
/// becomes the accumulator. u^n is kept until the step is complete: a step that fails leaves it untouched.
class schedule {
 public:
  /// What a contribution from stage j (0 is u^n) to accumulator k multiplies.
  enum class term {
    weight,          ///< α = r_k (j = 0) or p_kj + w_kj, β = Δt w_kj / r on T(u_j)
    minus_explicit,  ///< α = −d_kj/d_jj on the explicit part of u_j, before its collision …
    plus_solved,     ///< … and α = +d_kj/d_jj after it: together Δt d_kj Q(u_j)
    collision        ///< β = Δt d_kj on Q(u_j), evaluated
  };
  /// α u_j + β T(u_j) (or β Q(u_j)) to one accumulator.
  struct contribution {
    int stage;                ///< k
    int buffer;               ///< of accumulator k
    std::vector<term> terms;  ///< whose sums α and β are
    bool fresh;               ///< first contribution to k
  };
  /// Functions of a problem; see `problem` and `problem_with_explicit_collision`.
  enum class action { add_transport, add_collision, solve_collision };
  /// One call of such a function, for stage j.
  struct instruction {
    action what;                   ///< the function
    int stage;                     ///< j; 0 is u^n
    int buffer;                    ///< that holds u_j (or its explicit part)
    std::vector<contribution> to;  ///< none where stage j is solved
  };

  /// `embedded`: the last row of m is an embedded solution, and u^{n+1} the row before it. The stages are
  /// then made by the same sums in the same order as without it; what the row costs is counted with the
  /// others.
  template <class Real>
  explicit schedule(const shu_osher_form<Real>& m, bool embedded = false);

  /// In the order in which they are carried out.
  const std::vector<instruction>& instructions() const { return instructions_; }
  /// State-sized buffers that a step needs, u^n (buffer 0) included.
  int buffers() const { return buffers_; }
  /// Of u^{n+1}.
  int result_buffer() const { return result_; }
  /// Of the embedded solution; −1 if there is none.
  int embedded_buffer() const { return embedded_; }
  int transport_evaluations() const { return transports_; }  ///< of T per step
  int collision_evaluations() const { return collisions_; }  ///< of Q per step, those in solves not counted
  int implicit_solves() const { return solves_; }            ///< per step

 private:
  struct pattern;
  class builder;
  void build(const pattern& p);

  std::vector<instruction> instructions_;
  int buffers_ = 1, result_ = 0, embedded_ = -1, transports_ = 0, collisions_ = 0, solves_ = 0;
};

}  // namespace apsis
