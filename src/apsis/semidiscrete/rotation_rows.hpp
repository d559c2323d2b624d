#pragma once

#include <cstddef>

namespace apsis {

/// Loops over the angles of a ring of velocities, for the instruction set of this processor.
namespace rotation_rows {

/// One half of a ring of M angles, `apart` numbers each. Rotation is towards ω = 0: in the upper half,
/// 0 < ω < π, angles decrease, in the lower half they increase. Nothing crosses ω = 0 and ω = π.
struct half {
  int angles,  ///< M of the whole ring, a multiple of 4
      apart;   ///< distance of neighbouring angles
  bool lower;  ///< which half

  int count() const { return angles / 2 * apart; }           ///< numbers of a half
  int first() const { return lower ? count() : 0; }          ///< place of its first number in the ring
  int downstream() const { return lower ? apart : -apart; }  ///< distance to the next angle
};

/// Angles beyond either end of a ring whose values edges depend on.
inline constexpr int halo = 2;

/// Arrays of places: numbers of a half, with `apart` numbers before and behind them that are 0.
struct places {
  double *low_order,    ///< fluxes of first order out of each angle
      *fluxes,          ///< fluxes out of each angle
      *fractions,       ///< that the limiter leaves of corrections
      *limited_fluxes;  ///< limited fluxes

  /// Returns the numbers of an array.
  static std::size_t size(const half& of) { return static_cast<std::size_t>(of.count() + 2 * of.apart); }
};

/// How fluxes are found.
struct flux_rule {
  bool fifth_order,       ///< by the linear reconstruction of fifth order, else of first order
      limited;            ///< as upwind::add_limited() does
  const double* speeds;   ///< |sin ω| s of the edge downstream of every number of the half
  const double* inverse;  ///< 1/τ of every number of the half, in units of `scale`; null without limiter
  double scale;           ///< of 1/τ
};

/// values ← the ring with the angles of its halo.
void continue_ring(const double* ring, int angles, int apart, double* values);

/// change ← rate (flux in − flux out) of the numbers of a half, from `values`, the whole ring with its halo.
void turn(const half& of, const flux_rule& rule, const double* values, double rate, const places& to,
          double* change);

}  // namespace rotation_rows
}  // namespace apsis
