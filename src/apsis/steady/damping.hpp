#pragma once

#include <apsis/core/errors.hpp>

#include <cstddef>
#include <limits>
#include <string>

namespace apsis {

/// A failure to converge although every iteration yields a state.
class steady_stall : public numerical_error {
 public:
  /// `residual` is relative to that of the start.
  steady_stall(const std::string& problem, double residual)
      : numerical_error(problem), near_(residual < 1e-3) {}
  /// Returns true if the state is nearly steady. This happens, for example, if the weights of a
  /// reconstruction never settle. Starts from other ends then lead to the same states.
  bool is_near() const { return near_; }

 private:
  bool near_;
};

/// A stall for every start: the ends of the gas have different fluxes.
class steady_imbalance : public steady_stall {
 public:
  using steady_stall::steady_stall;
};

/// The pseudo-time term of the iteration, on the diagonal of J and in the rates of the sweep. It is 0 at
/// the start. A correction that is too large adds the weakest term, and iterations without progress
/// select stronger ones.
class damping {
 public:
  /// `strength` is that of the first iteration. It is limited to that of the strongest term.
  explicit damping(int strength = 0);
  /// Returns the strength of the strongest term.
  static int strongest();

  /// Largest relative change of density and energy in one iteration.
  static constexpr double largest_change = 0.3;

  /// Returns the part of the term that vanishes with `residual`. The residual is relative to that of the
  /// start. The unit is the rate of flight through the domain.
  double vanishing_rate(double residual) const;
  /// Returns the constant part, in the same units.
  double constant_rate() const;
  /// Returns the strength: 0 without a term, larger numbers for stronger terms.
  int strength() const { return static_cast<int>(strength_); }

  /// Records the relative residual of the next iteration. A reduction by a tenth is progress. Returns true if
  /// the term has become stronger. Throws steady_stall if the strongest term does not help.
  bool note_residual(double residual);
  /// Records the largest relative change in a correction. Returns true if a new term must
  /// replace the correction.
  bool note_change(double change);

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  void strengthen(double residual);

  std::size_t strength_;
  double best_ = infinite;     ///< smallest residual with this term
  int idle_ = 0;               ///< iterations without progress
  int large_corrections_ = 0;  ///< corrections with this term that were too large
};

}  // namespace apsis
