#pragma once

#include <apsis/boundary/oblique_wall.hpp>
#include <apsis/velocity/velocity_set.hpp>

#include <array>
#include <optional>

namespace apsis {

/// The fluxes of the molecules that arrive at a wall, per area and time. Dimensionless.
struct arriving_gas {
  double mass = 0.0;                    ///< Σ_out w |v_n| f
  std::array<double, 3> momentum = {};  ///< the same sums over v f
  double energy = 0.0;                  ///< the same sums over ½|v|² f, including internal energies
};

/// A wall with a temperature that is given or follows from the gas.
class wall_temperature {
 public:
  virtual ~wall_temperature() = default;
  /// Returns true if the temperature follows from the arriving molecules. The default is false: it is given.
  virtual bool follows_from_gas() const { return false; }
  /// Returns T_w at a point of a face or of a wall with any normal, given the arriving gas. Returns nothing
  /// if T_w has no effect. Throws as the wall does when it emits.
  virtual std::optional<double> temperature(const wall_point& where, const velocity_set& velocities,
                                            const arriving_gas& arriving) const = 0;
};

}  // namespace apsis
