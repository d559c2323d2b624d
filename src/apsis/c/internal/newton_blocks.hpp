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
#include <memory>
#include <span>
#include <utility>
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
  explicit newton_blocks(callbacks& of) : of_(of) { solvers_.push_back(std::make_unique<solver>(of)); }

  /// Ends the stage solves of all n unknowns at a share of the tolerances. Stages with b = 0 then share the
  /// derivative of their block in a step. Blocks with more entries of derivatives than most_kept are still
  /// solved to rounding errors, since each of them would keep its own.
  void set_tolerances(double relative, const std::vector<double>& absolute, std::size_t n) {
    const std::size_t size = of_.block_size;
    if (n > size && n > most_kept / size) return;
    solvers_.clear();
    for (std::size_t at = 0; at < n; at += size) {
      auto one = std::make_unique<solver>(of_);
      one->now.block = at / size;
      const auto begin = absolute.begin() + static_cast<std::ptrdiff_t>(absolute.size() == n ? at : 0);
      one->local.with_tolerances(component_tolerances<double>(
          {relative},
          absolute.size() == n ? state(begin, begin + static_cast<std::ptrdiff_t>(size)) : absolute));
      solvers_.push_back(std::move(one));
    }
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
    solve(t, a, b, u, [&](auto& local, state& one) { local.solve_collision(t, a, b, one); });
  }
  void solve_timed_collision(double t, double a, double b, state& u) {
    solve(t, a, b, u, [&](auto& local, state& one) { local.solve_timed_collision(t, a, b, one); });
  }
  void begin_step(double t, const state& u) {
    // One solver for several blocks has no tolerances.
    if (solvers_.size() * of_.block_size != u.size()) return;
    for (const auto& one : solvers_) {
      const auto begin = u.begin() + static_cast<std::ptrdiff_t>(one->now.block * of_.block_size);
      one_.assign(begin, begin + static_cast<std::ptrdiff_t>(of_.block_size));
      one->local.begin_step(t, one_);
    }
  }
  void end_step() {
    for (const auto& one : solvers_) one->local.end_step();
  }
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
  /// Largest number of entries of the derivatives that are kept for a step: 128 MiB.
  static constexpr std::size_t most_kept = std::size_t{1} << 24;

  /// Newton's method for a block.
  struct solver {
    explicit solver(callbacks& of) : local({}, block_field(of, now), options_of(of)) {
      local.with_admissible(
          [this, &of](std::span<const double> v) { return of.is_admissible(now.block, v); });
      if (of.pattern) local.with_sparsity(*of.pattern);
      if (of.mass) local.with_mass(*of.mass);
      if (of.precondition != nullptr)
        local.with_preconditioner([this, &of](double t, std::span<const double> v, double gamma) {
          return of.solver_of(now.block, t, v, gamma);
        });
    }
    solver(const solver&) = delete;  // the problem refers to the position
    solver& operator=(const solver&) = delete;

    stage_position now;
    newton_problem<no_transport, block_field> local;
  };

  /// Solves a stage block by block; solve_one(local, u) solves that of one block.
  template <class Solve>
  void solve(double t, double a, double b, state& u, const Solve& solve_one) {
    const std::size_t size = of_.block_size;
    solved_ = u;
    for (std::size_t block = 0; block * size < u.size(); ++block) {
      auto& [now, local] = *solvers_[solvers_.size() == 1 ? 0 : block];
      now.block = block;
      now.step = std::max(a, std::sqrt(std::abs(b)));
      ++now.solve;
      const auto begin = solved_.begin() + static_cast<std::ptrdiff_t>(block * size);
      one_.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
      if (solvers_.size() == 1 && size < u.size())
        local.begin_step(t, one_);  // nothing of another block serves
      try {
        solve_one(local, one_);
      } catch (const numerical_error& failure) {
        failure_site site = failure.site();
        if (size < u.size()) site.cell = static_cast<long>(block);
        throw numerical_error(failure.problem(), site);
      }
      if (a != 0.0 || b != 0.0) {
        of_.count(APSIS_STAGE_SOLVES);
        of_.count(APSIS_NEWTON_ITERATIONS, local.report().iterations);
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
  std::vector<std::unique_ptr<solver>> solvers_;  ///< one for all blocks, or one for each
  state work_, rate_, solved_, one_;
};

}  // namespace apsis::c
