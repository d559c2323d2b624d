#pragma once

#include "block_field.hpp"
#include "callbacks.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/integrate/array_state.hpp>
#include <apsis/integrate/component_tolerances.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/integrate/problem.hpp>

#include <algorithm>
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
      return work_;
    });
  }
  void add_collision(double, const state& u, targets to) {
    accumulate<state>(to, u, [&]() -> const state& {
      of_.evaluate_rate(u, work_);
      return work_;
    });
  }
  void add_transport_and_collision(double t, const state& u, targets to) {
    accumulate<state>(to, u, [&]() -> const state& {
      of_.evaluate_transport(t, u, work_);
      of_.evaluate_rate(u, rate_);
      for (std::size_t i = 0; i < work_.size(); ++i) work_[i] += rate_[i];
      return work_;
    });
  }
  void solve_collision(double t, double a, double b, state& u) {
    const std::size_t size = of_.block_size;
    solved_ = u;
    for (now_.block = 0; now_.block * size < u.size(); ++now_.block) {
      ++now_.solve;
      const auto begin = solved_.begin() + static_cast<std::ptrdiff_t>(now_.block * size);
      one_.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
      try {
        local_.solve_collision(t, a, b, one_);
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
