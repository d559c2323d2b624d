#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/semidiscrete/rotation_rows.hpp>
#include <apsis/velocity/polar_layout.hpp>

#include <array>
#include <cstddef>

namespace apsis {

/// The linear operator F ↦ (1/r) ∂_ω(v_⊥ sin ω F) on a row of velocities in rings, as upwind differences
/// without limiter (ring_rotation), and the speeds at the edges between angles. Dimensionless.
class ring_turn {
 public:
  /// Memory of one thread.
  struct workspace {
    std::array<aligned_vector<double>, 4> places;  ///< memory of rotation_rows::places
    aligned_vector<double> values;                 ///< a ring with its halo
  };

  /// Differences have fifth order or first order.
  ring_turn(polar_layout layout, bool fifth_order);

  const polar_layout& layout() const { return layout_; }  ///< the velocities
  /// Returns the numbers of a ring in a row.
  std::size_t size_of_ring() const { return speeds_.size() - static_cast<std::size_t>(layout_.apart); }
  /// Returns v_⊥ of a ring. Rings of a second set of components repeat those of the first.
  double speed_of(std::size_t ring) const { return layout_.speeds[ring % layout_.speeds.size()]; }
  /// Returns Δω.
  double width() const;
  /// Returns s |sin ω| at the edge where component k flows out, s = ½Δω/sin ½Δω.
  double outflow(std::size_t k) const;
  /// Returns s |sin ω| at the edge where the flow enters component k.
  double inflow(std::size_t k) const;
  /// Returns the distance from component k to the one upstream in its ring, ± the distance of angles.
  int upstream(std::size_t k) const;

  /// Returns memory for one thread.
  workspace make_workspace() const;
  /// Returns the rule for fluxes, without limiter.
  rotation_rows::flux_rule rule() const;
  /// change ← the differences of a ring at the radius r.
  void apply_to_ring(const double* row, std::size_t ring, double radius, const rotation_rows::flux_rule& rule,
                     workspace& here, double* change) const;
  /// change ← the differences of a row of `components` numbers at the radius r.
  void apply(const double* row, std::size_t components, double radius, workspace& here, double* change) const;

 private:
  bool in_upper_half(std::size_t k) const { return 2 * (k % size_of_ring()) < size_of_ring(); }

  polar_layout layout_;
  bool fifth_order_;
  double stretch_;                 ///< s
  aligned_vector<double> speeds_,  ///< s |sin ω| of the edges of a ring, `apart` numbers each
      slopes_;                     ///< Δω cos ω of the edges
};

}  // namespace apsis
