#pragma once

#include <apsis/boundary/boundary.hpp>
#include <apsis/run/internal/surface_columns.hpp>
#include <apsis/run/setup.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// Computes the mean temperatures of found_walls().
class wall_temperatures {
 public:
  /// `setup` must outlive the object.
  explicit wall_temperatures(const run_setup& setup);

  /// Returns the number of walls.
  std::size_t size() const { return walls_; }
  /// Returns Σ A T_w/Σ A over the pieces of each wall. A is the area of a piece, T_w the temperature that
  /// compute_surfaces() has at time t. `observed` is face_fluxes::observed() at the ends of this process.
  /// Pieces at which nothing arrives do not count. The result is NaN without other pieces, or if nothing is
  /// observed. Sums are exact and rounded once. Collective.
  std::vector<double> of(double t, std::span<const double> observed) const;

 private:
  struct piece {
    std::size_t wall, end;  ///< indices of its wall, and of its end on this process
    const boundary* side;
    std::array<double, 3> normal;  ///< into the gas
    position x;
    double area;
  };
  void add_pieces(std::size_t wall, const budget_surface& one, std::size_t end);

  const run_setup& setup_;
  wall_temperature_column temperature_;
  std::size_t walls_ = 0;
  std::vector<piece> pieces_;
};

}  // namespace apsis
