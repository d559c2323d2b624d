#include "internal/stage_newton.hpp"

#include <apsis/c/internal/guarded.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace apsis::sundials {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();

/// Part of the tolerance that a stage solve may spend. Extrapolated Euler steps multiply errors of their
/// solves by up to 300.
constexpr double share = 1e-3;

/// Number of stages for which a Jacobian serves as preconditioner, unless Newton's method becomes slow.
constexpr int oldest = 20;

constexpr int most_iterations = 100;

/// Growth of a vector by the matrix of a stage that explains why GMRES without a preconditioner fails.
constexpr double stiff = 1e5;

}  // namespace

void set_weights(double relative, N_Vector absolute, N_Vector y, N_Vector w) {
  N_VAbs(y, w);
  N_VLinearSum(relative, w, 1.0, absolute, w);
  N_VInv(w, w);
}

bool satisfies(const nvector& constraints, N_Vector y, N_Vector mask) {
  return !constraints || N_VConstrMask(constraints.get(), y, mask);
}

stage_newton::stage_newton(functions& of, const stage_accuracy& accuracy, const nvector& like)
    : of_(of),
      accuracy_(accuracy),
      systems_(of, like),
      now_{like.another(), like.another(), like.another(), like.another(), like.another()},
      next_{like.another(), like.another(), like.another(), like.another(), like.another()},
      weights_(like.another()),
      work_(like.another()) {}

void stage_newton::require(int returned, const char* problem) {
  if (refusal& refused = systems_.at().refused()) {
    const refusal kept = std::exchange(refused, {});
    c::require_success(kept.name, kept.returned);
  }
  if (returned != 0)
    throw numerical_error(
        fmt::format("{} (the linear solver of a stage returned {}); reduce the time step, improve the "
                    "preconditioner, or allow more iterations",
                    problem, returned));
}

/// Sets k and r. Returns whether Q accepts the state and is finite; throws the error of a failed callback.
bool stage_newton::evaluate(const stage& s, iterate& at) {
  N_Vector v = at.v.get(), k = at.k.get(), r = at.r.get();
  at.admissible = satisfies(accuracy_.constraints, v, work_.get());
  if (!of_.try_collision(s.t, v, k)) return false;
  int returned = systems_.at().move_to(s.t, v, k);
  N_VLinearSum(1.0, s.u, s.a, k, r);
  if (s.b != 0.0 && returned == 0) {
    returned = systems_.at().product(k, at.jk.get());
    N_VLinearSum(1.0, r, s.b, at.jk.get(), r);
  }
  if (returned > 0) systems_.at().refused() = {};
  if (returned < 0) require(returned, "the Jacobian has no products");
  if (returned != 0) return false;
  if (s.timed && s.b != 0.0) add_time_derivative(s, at);
  N_VLinearSum(1.0, r, -1.0, v, r);
  at.residual = N_VWrmsNorm(r, weights_.get());
  return std::isfinite(at.residual);
}

/// r ← r + b ∂Q/∂t, by a central difference.
void stage_newton::add_time_derivative(const stage& s, iterate& at) {
  // √|b| is a part of the step. If Q changes on the time scale τ, the relative truncation error is about
  // 2e-7 |b|/τ². Rounding errors of Q are multiplied by at most 1e3 √|b|. The second bound of h exceeds the
  // rounding of t.
  const double h = 1e-3 * std::max(std::sqrt(std::abs(s.b)), 1e-6 * std::abs(s.t));
  const double before = s.t - h, after = s.t + h;
  for (const auto& [t, weight] : {std::pair(after, s.b), std::pair(before, -s.b)}) {
    of_.evaluate_collision(t, at.v.get(), work_.get());
    N_VLinearSum(1.0, at.r.get(), weight / (after - before), work_.get(), at.r.get());
  }
}

/// Prepares the preconditioner, with new data of J at its present state or with earlier data.
void stage_newton::prepare(const stage& s, bool fresh) {
  require(systems_.prepare(s.a, s.b, fresh), "the matrix of Newton's method cannot be factorized");
  known_a_ = s.a;
  known_b_ = s.b;
  fresh_ = fresh;
  if (fresh) age_ = 1;
}

/// Sets δ for the residual of an iterate, the present state of J. Its error is at most a tenth of its size or
/// of the accuracy. `expected` is the size that δ may have.
void stage_newton::correct(const stage& s, iterate& at, double expected) {
  constexpr double least = 0.1;
  // J² has the square of the stiffness: (I − γJ)⁻² of another state would mix slow and fast components by
  // more than it damps the fast ones.
  if (s.b != 0.0) prepare(s, true);
  systems_.set_curvature(curved_, at.jk.get());
  double tolerance = std::max(least, 1e-3 * expected);
  for (;;) {
    of_.count(APSIS_SUNDIALS_NEWTON_ITERATIONS);
    const int returned = systems_.solve(at.r.get(), at.delta.get(), weights_.get(), unit_ * tolerance);
    at.size = N_VWrmsNorm(at.delta.get(), weights_.get()) / unit_;
    if (linear_systems::is_progress(returned) && std::isfinite(at.size)) {
      // A solver does nothing if the residual is below its tolerance.
      if (systems_.is_exact() || tolerance <= std::max(least, 0.1 * at.size)) return;
      tolerance = std::max(least, std::min(1e-2 * at.size, 1e-4 * tolerance));
      continue;
    }
    if (fresh_) systems_.require_solvable(stiff);
    if (fresh_) require(returned != 0 ? returned : -1, "a linear system of Newton's method is not solved");
    systems_.at().refused() = {};
    prepare(s, true);
  }
}

/// Computes δ of the present iterate again, with a preconditioner of its own and second derivatives.
void stage_newton::correct_again(const stage& s) {
  require(systems_.at().move_to(s.t, now_.v.get(), now_.k.get()), "the Jacobian has no products");
  if (s.b == 0.0) prepare(s, true);
  curved_ = true;
  correct(s, now_, now_.size);
}

/// Whether δ is so small that it may consist of rounding errors.
bool stage_newton::is_small(const iterate& at) const {
  return at.size <= noise_ ||
         (!accuracy_.absolute && N_VMaxNorm(at.delta.get()) <= 1e-12 * N_VMaxNorm(at.v.get()));
}

/// Whether the iterate is accurate after its correction. The error of a sequence of corrections that decrease
/// by θ is θ/(1 − θ) of the last one. Corrections that no longer decrease may be rounding errors; these
/// suffice, too.
bool stage_newton::is_done(double before) const {
  if (!std::isfinite(before)) return now_.size <= 1.0;
  const double theta = now_.size / before;
  return (now_.size <= 1.0 && theta <= 0.5) || (theta < 1.0 && now_.size * theta / (1.0 - theta) <= 1.0) ||
         (theta > 0.5 && is_small(now_));
}

/// Moves to the next iterate by a part of δ. Returns whether there is one.
bool stage_newton::advance(const stage& s) {
  for (double length = 1.0; length >= 0x1p-20; length /= 2.0) {
    N_VLinearSum(1.0, now_.v.get(), length, now_.delta.get(), next_.v.get());
    if (!evaluate(s, next_) || (now_.admissible && !next_.admissible)) continue;
    fresh_ = false;
    correct(s, next_, now_.size);
    if (next_.size <= (1.0 - length / 4.0) * now_.size ||
        next_.residual <= (1.0 - 1e-4 * length) * now_.residual || (length == 1.0 && is_small(now_))) {
      std::swap(now_, next_);
      return true;
    }
  }
  return false;
}

/// Adds the last correction, unless the result violates the constraints. Throws numerical_error if v violates
/// them.
void stage_newton::finish(const stage& s) {
  N_VLinearSum(1.0, now_.v.get(), 1.0, now_.delta.get(), next_.v.get());
  next_.admissible = satisfies(accuracy_.constraints, next_.v.get(), work_.get());
  if (is_finite(next_.v.get()) && (next_.admissible || !now_.admissible)) std::swap(now_.v, next_.v);
  if (!satisfies(accuracy_.constraints, now_.v.get(), work_.get()))
    throw numerical_error(fmt::format(
        "a stage at t = {:.10g} has no solution that satisfies the constraints (Newton's method ends outside "
        "of them); reduce the time step, or use an unconditionally SSP method",
        s.t));
}

/// Whether Newton's method should begin near equilibrium. Rounding errors of r, whose stiff part has the
/// square of the stiffness, would hide the slow components of v. If Q changes an unknown by more than its
/// size in the time √−b of the second derivative, the equation also has other roots than the one that short
/// steps lead to.
bool stage_newton::is_far_from_equilibrium(const stage& s) const {
  constexpr double most = 1e6;
  if (N_VMaxNorm(now_.r.get()) > most * N_VMaxNorm(now_.v.get())) return true;
  const double relative = accuracy_.absolute ? accuracy_.relative : 1.0;
  N_VProd(now_.k.get(), weights_.get(), work_.get());
  return std::sqrt(-s.b) * relative * N_VMaxNorm(work_.get()) > 1.0;
}

void stage_newton::start_at(const stage& s) {
  if (!evaluate(s, now_))
    throw numerical_error(
        fmt::format("Q or its derivative at t = {:.10g} is not finite, or rejects the explicit part of a "
                    "stage; reduce the time "
                    "step, or check the callbacks",
                    s.t));
}

/// Finds the root, starting from the solution of an implicit Euler step. Returns whether that is possible;
/// the iterate is the explicit part otherwise.
bool stage_newton::find_root_from_implicit_euler(const stage& s) {
  const stage euler{s.t, std::max(s.a, std::sqrt(-s.b)), 0.0, false, s.u};
  bool found = true;
  try {
    start_at(euler);
    find_root(euler);
    N_VLinearSum(1.0, now_.v.get(), 1.0, now_.delta.get(), now_.v.get());
    start_at(s);
    find_root(s);
  } catch (const numerical_error&) {
    found = false;
  }
  if (found) return true;
  N_VScale(1.0, s.u, now_.v.get());
  start_at(s);
  return false;
}

/// Throws numerical_error. `does` completes the sentence "Newton's method …".
void stage_newton::fail(const stage& s, const std::string& does) const {
  systems_.require_solvable(stiff);
  throw numerical_error(
      fmt::format("a stage at t = {:.10g} is not solved (Newton's method {}); reduce the time step, or "
                  "improve the preconditioner",
                  s.t, does));
}

/// Finds the root, starting from the present iterate; the last correction is not added.
void stage_newton::find_root(const stage& s) {
  fresh_ = curved_ = false;
  const bool old = age_ == 0 || age_ > oldest;
  if (s.b == 0.0 && (old || s.a != known_a_ || s.b != known_b_)) prepare(s, old);
  ++age_;
  correct(s, now_, accuracy_.absolute ? 0.0 : 1e-4 / rounding);
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; !is_done(before); ++k) {
    if (k == most_iterations) fail(s, fmt::format("does not converge in {} iterations", k));
    before = now_.size;
    const bool improves = s.b != 0.0 ? !curved_ : !fresh_;
    const bool moved = advance(s);
    if (moved && now_.size <= 0.5 * before) continue;
    if (improves) {
      correct_again(s);
      before = std::numeric_limits<double>::infinity();
    } else if (!moved) {
      fail(s, fmt::format("finds no better state with a correction {:.3g} times the accuracy", now_.size));
    }
  }
  systems_.require_solvable();
}

void stage_newton::solve(double t, bool timed, double a, double b, nvector& u) {
  const stage s{t, a, b, timed, u.get()};
  of_.count(APSIS_SUNDIALS_STAGE_SOLVES);
  if (accuracy_.absolute) {
    set_weights(accuracy_.relative, accuracy_.absolute.get(), u.get(), weights_.get());
    unit_ = share;
    noise_ = std::max(10.0, 1e-12 / share * N_VWrmsNorm(u.get(), weights_.get()));
  } else {
    const double largest = N_VMaxNorm(u.get());
    N_VConst(1e-6 * (largest > 0.0 ? largest : 1.0), work_.get());
    set_weights(1.0, work_.get(), u.get(), weights_.get());
    unit_ = rounding;
    noise_ = 1e-9 / rounding;
  }
  now_.v = u;
  start_at(s);
  if (b == 0.0 || !is_far_from_equilibrium(s) || !find_root_from_implicit_euler(s)) find_root(s);
  finish(s);
  u.swap(now_.v);
}

}  // namespace apsis::sundials
