#pragma once

#include <cstddef>

namespace apsis {

/// Loops over the angles of a ring of velocities, for the instruction set of this processor.
namespace rotation_rows {

/// A ring of M angles, a multiple of 4, with `apart` numbers each. Rotation is towards ω = 0: angles decrease
/// in the half 0 < ω < π and increase in the other half.
struct ring {
  int angles,  ///< M
      apart;   ///< distance of neighbouring angles

  int half() const { return angles / 2 * apart; }  ///< numbers of a half
  int size() const { return angles * apart; }      ///< numbers of the ring
  int edges() const { return size() + apart; }     ///< numbers of edges; the first and the last one are ω = 0
  std::size_t continued() const;                   ///< numbers with `halo` angles beyond each end
  std::size_t places() const;                      ///< numbers of an array of `places`
};

/// Angles beyond each end of a ring that edges depend on.
inline constexpr int halo = 2;

/// Arrays of both halves. `apart` numbers of the other half precede and follow each half.
struct places {
  double *low_order,    ///< fluxes of first order out of each angle
      *fluxes,          ///< fluxes out of each angle
      *fractions,       ///< fractions of the corrections that the limiter leaves
      *limited_fluxes;  ///< limited fluxes
};

/// The rule for fluxes.
struct flux_rule {
  bool fifth_order,       ///< corrections of the reconstruction (rotation.hpp); else first order
      limited;            ///< limited like upwind::add_limited()
  const double *speeds,   ///< s |sin ω| of every edge
      *slopes;            ///< Δω cos ω of every edge
  double first,           ///< factor of Δω ∂F in a flux
      third,              ///< factor of Δω³ ∂³F
      second;             ///< factor of Δω² ∂²F, in addition to the speed
  const double* inverse;  ///< 1/τ of every number, in units of `scale`; null without limiter
  double scale;           ///< factor of 1/τ
};

/// values ← the ring, continued by the angles of its halo.
void continue_ring(const ring& of, const double* row, double* values);

/// change ← rate (flux in − flux out) of every number, from the ring with its halo.
void turn(const ring& of, const flux_rule& rule, const double* values, double rate, const places& to,
          double* change);

}  // namespace rotation_rows
}  // namespace apsis
