#pragma once

#include <apsis/core/errors.hpp>

#include <cstddef>
#include <limits>
#include <string>

namespace apsis {

/// The iteration does not find a steady state although it finds a state in every iteration.
class steady_stall : public numerical_error {
 public:
  /// `residual`: relative to that of the start.
  steady_stall(const std::string& problem, double residual)
      : numerical_error(problem), near_(residual < 1e-3) {}
  /// Whether the state is nearly steady, as where the weights of a reconstruction never settle: starts from
  /// other ends lead to the same states.
  bool is_near() const { return near_; }

 private:
  bool near_;
};

/// A stall that another start will not end: the ends of the gas have different fluxes.
class steady_imbalance : public steady_stall {
 public:
  using steady_stall::steady_stall;
};

/// The pseudo-time term of the iteration, on the diagonal of J and in the rates of the sweep. It is 0 at the
/// start. A correction that is too large calls for a weak one, and iterations without progress call for
/// stronger ones.
class damping {
 public:
  /// `strength`: that of the first iteration, at most that of the strongest term.
  explicit damping(int strength = 0);
  /// Returns the strength of the strongest term.
  static int strongest();

  /// Largest relative change of density and energy in one iteration.
  static constexpr double largest_change = 0.3;

  /// Returns the part of the term that vanishes with `residual`, which is relative to that of the start. In
  /// units of the rate of flight through the domain.
  double vanishing_rate(double residual) const;
  /// Returns the constant part, in the same units.
  double constant_rate() const;
  /// Returns 0 without a term, and a larger number for a stronger one.
  int strength() const { return static_cast<int>(strength_); }

  /// Notes the relative residual of the next iteration; one that falls by a tenth is progress. Returns
  /// whether the term has become stronger. Throws steady_stall where the strongest one does not help.
  bool note_residual(double residual);
  /// Notes the largest relative change in a correction. Returns whether there is a term now that replaces the
  /// correction.
  bool note_change(double change);

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  void strengthen(double residual);

  std::size_t strength_;
  double best_ = infinite;     ///< residual with this term
  int idle_ = 0;               ///< iterations without progress
  int large_corrections_ = 0;  ///< with this term
};

}  // namespace apsis
