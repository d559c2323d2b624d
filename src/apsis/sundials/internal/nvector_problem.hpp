#pragma once

#include "functions.hpp"
#include "nvector.hpp"
#include "stage_newton.hpp"

#include <apsis/integrate/problem.hpp>

#include <optional>
#include <span>

namespace apsis::sundials {

/// u' = T(t, u) + Q(t, u) on N_Vectors. The program or stage_newton solves the stages.
class nvector_problem {
 public:
  using state = nvector;
  using real = double;
  using targets = std::span<const target<state, double>>;

  /// Stores references; vectors are made like `like`.
  nvector_problem(functions& of, const stage_accuracy& accuracy, const nvector& like);

  void add_transport(double t, const state& u, targets to);
  void add_collision(double t, const state& u, targets to);
  void add_transport_and_collision(double t, const state& u, targets to);
  void solve_collision(double t, double a, double b, state& u) { solve(t, false, a, b, u); }
  void solve_timed_collision(double t, double a, double b, state& u) { solve(t, true, a, b, u); }
  void combine(std::span<const linear_term<state, double>> terms, state& sum);
  bool has_transport(double t, const state& u);
  bool is_admissible(const state& u);
  double forward_euler_step(double t, const state& u) const {
    return of_.time_of(of_.forward_euler_step, "forward_euler_step", t, u.get());
  }
  double relaxation_time(double t, const state& u) const {
    return of_.time_of(of_.relaxation_time, "relaxation_time", t, u.get());
  }

 private:
  template <class Evaluate>
  void accumulate(const state& u, targets to, const Evaluate& evaluate);
  void solve(double t, bool timed, double a, double b, state& u);

  functions& of_;
  const stage_accuracy& accuracy_;
  nvector rate_, other_, work_;
  std::optional<stage_newton> newton_;
};

static_assert(problem_with_explicit_collision<nvector_problem> &&
              problem_with_timed_collision<nvector_problem> && problem_with_combination<nvector_problem> &&
              problem_with_admissible_set<nvector_problem> && problem_with_relaxation_time<nvector_problem>);

}  // namespace apsis::sundials
