#pragma once

#include "callbacks.hpp"

#include <apsis/integrate/difference_derivatives.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace apsis::c {

/// The stage solve in progress.
struct stage_position {
  std::size_t block = 0;  ///< number of its block
  long long solve = 0;    ///< number of the solve
  double step = 1.0;      ///< a part of the step, about as long as the stage
};

/// A Jacobian matrix and the state at which it was evaluated, because a dense linear system uses it column by
/// column. It is not kept for later solves, because a program may change its data before them.
class known_jacobian {
 public:
  /// jx ← Q'(u) x. Throws numerical_error if Q' is not finite.
  void product(callbacks& of, const stage_position& now, std::span<const double> u, std::span<const double> x,
               std::span<double> jx);

 private:
  std::vector<double> at_, matrix_;
  long long solve_ = -1;
};

/// Q on one block as a function of t and u, for differences.
struct block_rate {
  callbacks* of;
  const stage_position* now;

  /// q ← Q(t, u); NaN if the rate rejects u.
  void operator()(double t, std::span<const double> u, std::span<double> q) const;
};

/// Q and its derivatives on one block (`differentiated_in_time` of integrate/autodiff.hpp).
class block_field {
 public:
  /// Stores references.
  block_field(callbacks& of, const stage_position& now)
      : of_(&of), now_(&now), differences_(block_rate{&of, &now}) {}

  /// Sets the time of all evaluations that follow.
  void set_time(double t) {
    t_ = t;
    differences_.set_time(t);
  }
  /// out ← Q(t, u).
  void value(std::span<const double> u, std::span<double> out) {
    of_->evaluate_block(t_, now_->block, u, out);
  }
  /// out ← ∂Q/∂t by a central difference over a small part of the step; 0 for Q(u).
  void time_derivative(std::span<const double> u, std::span<double> out);
  /// jx ← ∂Q/∂u x, by a difference unless the program has a function for derivatives.
  void jacobian_product(std::span<const double> u, std::span<const double> x, std::span<double> jx) {
    product(middle_, u, x, jx);
  }
  /// hx ← Q''(u)[k, x], by differences, to a few digits, unless the program has a function for it.
  void curvature(std::span<const double> u, std::span<const double> k, std::span<const double> x,
                 std::span<double> hx);

 private:
  void product(known_jacobian& known, std::span<const double> u, std::span<const double> x,
               std::span<double> jx);

  callbacks* of_;
  const stage_position* now_;
  double t_ = 0.0;
  known_jacobian before_, middle_, after_;
  difference_derivatives<block_rate> differences_;
  std::vector<double> moved_, other_;
};

}  // namespace apsis::c
