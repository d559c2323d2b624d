#pragma once

#include "callbacks.hpp"

#include <apsis/integrate/array_state.hpp>
#include <apsis/integrate/problem.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace apsis::c {

/// u' = T(t, u) + Q(u) with the stage solver or the flow of the program. Without them Q = 0.
class split_problem {
 public:
  using state = std::vector<double>;
  using real = double;
  using targets = std::span<const target<state, double>>;

  /// Stores a reference.
  explicit split_problem(callbacks& of) : of_(of) {}

  void add_transport(double t, const state& u, targets to) {
    accumulate<state>(to, u, [&]() -> const state& {
      of_.evaluate_transport(t, u, work_);
      return work_;
    });
  }
  void add_collision(double t, const state& u, targets to) {
    accumulate<state>(to, u, [&]() -> const state& {
      of_.evaluate_rate(t, u, work_);
      return work_;
    });
  }
  void add_transport_and_collision(double t, const state& u, targets to) {
    accumulate<state>(to, u, [&]() -> const state& {
      of_.evaluate_transport(t, u, work_);
      of_.evaluate_rate(t, u, rate_);
      for (std::size_t i = 0; i < work_.size(); ++i) work_[i] += rate_[i];
      return work_;
    });
  }
  void solve_collision(double t, double a, double b, state& u) {
    if (of_.stage != nullptr && (a != 0.0 || b != 0.0)) {
      of_.count(APSIS_STAGE_SOLVES);
      require_success("stage", of_.stage(t, a, b, u.size(), u.data(), of_.data));
    }
    of_.require_valid(u);
  }
  void advance_collision(double t, double s, state& u) {
    if (of_.flow != nullptr) {
      of_.count(APSIS_FLOW_EVALUATIONS);
      require_success("flow", of_.flow(t, s, u.size(), u.data(), of_.data));
    }
    of_.require_valid(u);
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
  double relaxation_time(double t, const state& u) const {
    return of_.time_of(of_.relaxation_time, "relaxation_time", t, u);
  }

 private:
  callbacks& of_;
  state work_, rate_;
};

}  // namespace apsis::c
