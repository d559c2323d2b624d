#pragma once

#include "block_field.hpp"
#include "callbacks.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/integrate/array_state.hpp>
#include <apsis/integrate/component_tolerances.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/integrate/problem.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace apsis::c {

/// u' = T(t, u) + Q(u), where Q couples only unknowns of the same block. Newton's method solves the stages
/// block by block. With one block the results are those of a newton_problem, bit for bit.
class newton_blocks {
 public:
  using state = std::vector<double>;
  using real = double;
  using targets = std::span<const target<state, double>>;

  /// Stores a reference.
  explicit newton_blocks(callbacks& of) : of_(of), local_({}, block_field(of, now_), options_of(of)) {
    local_.with_admissible([this](std::span<const double> v) { return of_.is_admissible(now_.block, v); });
    if (of.pattern) local_.with_sparsity(*of.pattern);
    if (of.mass) local_.with_mass(*of.mass);
  }
  /// Ends the stage solves of a single block of n unknowns at a share of the tolerances. Its stages with b =
  /// 0 then share the derivative of a step. Stages of several blocks are solved to rounding errors, because
  /// each block would need a derivative of its own.
  void set_tolerances(const component_tolerances<double>& tolerances, std::size_t n) {
    if (of_.block_size == n) local_.with_tolerances(tolerances);
  }
  newton_blocks(const newton_blocks&) = delete;
  newton_blocks& operator=(const newton_blocks&) = delete;

  void add_transport(double t, const state& u, targets to) {
    accumulate<state>(to, u, [&]() -> const state& {
      of_.evaluate_transport(t, u, work_);
      divide_by_mass(work_);
      return work_;
    });
  }
  void add_collision(double t, const state& u, targets to) {
    accumulate<state>(to, u, [&]() -> const state& {
      of_.evaluate_rate(t, u, work_);
      divide_by_mass(work_);
      return work_;
    });
  }
  void add_transport_and_collision(double t, const state& u, targets to) {
    accumulate<state>(to, u, [&]() -> const state& {
      of_.evaluate_transport(t, u, work_);
      of_.evaluate_rate(t, u, rate_);
      for (std::size_t i = 0; i < work_.size(); ++i) work_[i] += rate_[i];
      divide_by_mass(work_);
      return work_;
    });
  }
  void solve_collision(double t, double a, double b, state& u) {
    solve(a, b, u, [&](state& one) { local_.solve_collision(t, a, b, one); });
  }
  void solve_timed_collision(double t, double a, double b, state& u) {
    solve(a, b, u, [&](state& one) { local_.solve_timed_collision(t, a, b, one); });
  }
  void begin_step(double t, const state& u) { local_.begin_step(t, u); }
  void end_step() { local_.end_step(); }
  bool has_transport(double t, const state& u) {
    if (of_.transport == nullptr) return false;
    of_.evaluate_transport(t, u, work_);
    return !is_zero(work_);
  }
  bool is_admissible(const state& u) const { return !of_.first_inadmissible(u); }
  double forward_euler_step(double t, const state& u) const {
    return of_.time_of(of_.forward_euler_step, "forward_euler_step", t, u);
  }

 private:
  /// Solves a stage block by block; solve_one(u) solves that of one block.
  template <class Solve>
  void solve(double a, double b, state& u, const Solve& solve_one) {
    now_.step = std::max(a, std::sqrt(std::abs(b)));
    const std::size_t size = of_.block_size;
    solved_ = u;
    for (now_.block = 0; now_.block * size < u.size(); ++now_.block) {
      ++now_.solve;
      const auto begin = solved_.begin() + static_cast<std::ptrdiff_t>(now_.block * size);
      one_.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
      try {
        solve_one(one_);
      } catch (const numerical_error& failure) {
        failure_site site = failure.site();
        if (size < u.size()) site.cell = static_cast<long>(now_.block);
        throw numerical_error(failure.problem(), site);
      }
      if (a != 0.0 || b != 0.0) {
        of_.count(APSIS_STAGE_SOLVES);
        of_.count(APSIS_NEWTON_ITERATIONS, local_.report().iterations);
      }
      std::copy(one_.begin(), one_.end(), begin);
    }
    u.swap(solved_);
  }
  /// Sets the blocks of x to M⁻¹ x.
  void divide_by_mass(state& x) const {
    if (!of_.mass) return;
    const std::span<double> all(x);
    for (std::size_t at = 0; at < x.size(); at += of_.block_size)
      of_.mass->divide(all.subspan(at, of_.block_size));
  }

  static newton_options options_of(const callbacks& of) {
    newton_options options;
    options.dense_limit = of.dense_limit;
    return options;
  }

  callbacks& of_;
  stage_position now_;
  newton_problem<no_transport, block_field> local_;
  state work_, rate_, solved_, one_;
};

}  // namespace apsis::c
