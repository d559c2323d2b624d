#pragma once

#include <apsis/method/method.hpp>

#include <optional>
#include <vector>

namespace apsis {

/// What an embedded solution may cost.
enum class embedded_cost {
  nothing,   ///< ũ = r̃ u^n + Σ_j p̃_j u_j; of an explicit method also w̃_j where T(u_j) is known anyway
  one_solve  ///< w̃_j, d̃ and d̃̇ too: one more solve of Q
};

/// What is asked of an embedded solution.
struct embedded_task {
  int order = 0;  ///< q of ũ; 0: the highest below that of the method for which there is a useful one
  embedded_cost cost = embedded_cost::one_solve;  ///< what ũ may cost
  int parts = 10;            ///< u^{n+1} − ũ is to be 1/parts of the Taylor term of order q + 1: θ = 1/parts
  double useful = 0.15;      ///< least embedded_attempt::seen
  double margin = 1.0 / 64;  ///< d̃ + |d̃̇| at least, where there is a solve
};

/// How the search for one order ended.
struct embedded_attempt {
  int order = 0;  ///< the order q that was tried
  double nearest =
      0.0;  ///< largest |equation| at the nearest point of x ≥ 0; rounding if there is a solution
  /// ‖t − E x‖/(θ ‖t‖) over the trees of T alone, or over those of Q alone if that is smaller: what the
  /// estimate sees of the limit ε → 0, and of relaxation without transport. 0 for u^{n+1} itself.
  double seen = 0.0;
};

/// What find_embedded() found, and how it came to it.
struct embedded_search {
  std::optional<embedded_row> found;       ///< with 45 digits, or exact rationals where it has small ones
  std::vector<embedded_attempt> attempts;  ///< from the highest order down
};

/// An embedded solution of order q of a method of order p > q, convex, and useful to estimate the error with.
///
/// Its unknowns x = (p̃_j, w̃_j, r̃, d̃, −d̃̇) ≥ 0 satisfy linear equations: at the new row the order conditions
/// say that φ̃(τ) = 1/γ(τ) for |τ| ≤ q, so of the products under the root of a tree of order ≤ q + 1 all
/// factors are known there. With φ_j, g_j, h_j the stage vectors of the method and the products under the
/// root, and g̃, h̃ the same of 1/γ,
///   root T:  φ̃ = Σ_j (p̃_j + w̃_j) φ_j + (1/r) Σ_j w̃_j g_j
///   root Q:  φ̃ = Σ_j (p̃_j + w̃_j) φ_j + d̃ g̃ + d̃̇ h̃.
/// For |τ| ≤ q these are equations, A x = b, with r̃ + Σ_j (p̃_j + w̃_j) = 1. For |τ| = q + 1 they are E x, and
/// u^{n+1} − ũ = Δt^{q+1} Σ_τ (1/γ(τ) − (E x)_τ) F(τ)/σ(τ) + …; if E x = (1 − θ) t with t_τ = 1/γ(τ), that is
/// θ times the Taylor term, and no elementary differential is seen more than another. So x is
///   arg min Σ_k ‖E_k x − (1 − θ) t_k‖²/‖t_k‖²   over A x = b, x ≥ 0,   for the better sign of θ,
/// k over the trees of T alone, of Q alone, and the others. This is a convex problem, solved in 60 digits by
/// nonnegative_least_squares(). u_j and T(u_j) of the last stage, which is u^{n+1}, have no weight: mixing
/// with u^{n+1} only makes θ smaller. w̃_j only where T(u_j) is evaluated anyway.
///
/// If the method claims to keep the terms of size ε where ε ≪ Δt, ũ keeps that of u^{n+1}: Σ_j w̃_j/r = d̃ and
/// d̃̇ = 0 ((N2) of docs/plateaus.md, linear too). Otherwise u^{n+1} − ũ would stall at a multiple of ε.
///
/// The row of u^{n+1} satisfies all equations, with an estimate of nothing. Where there is no other, or none
/// that sees enough of the trees of one colour, the order q is given up. Throws input_error for methods
/// without diagonal D, with an update, or of order 1, and orders that are not below p.
embedded_search find_embedded(const method& m, const embedded_task& task);

}  // namespace apsis
