#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/model/acceleration.hpp>
#include <apsis/model/model.hpp>
#include <apsis/model/source_rate.hpp>
#include <apsis/semidiscrete/ring_turn.hpp>
#include <apsis/steady/cell_links.hpp>
#include <apsis/steady/cut_links.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace apsis {

class tangent_rows;

/// Force, source and rotation inside a domain, in addition to those of the model.
struct inside_domain {
  std::optional<acceleration> force = {};  ///< of a gas
  std::optional<source_rate> source = {};  ///< of any model
  std::optional<ring_turn> turn = {};  ///< in axisymmetric flow, where r is the last direction of the mesh
};

/// Offsets of the blocks of J among the numbers of a cell. A block has m² numbers, row by row,
/// m = relaxation_model::moment_count().
struct jacobian_layout {
  int directions = 1,   ///< directions of the mesh
      moments = 1;      ///< m
  bool source = false,  ///< whether there is a block of ∂S/∂ω
      turns = false;    ///< whether there are blocks of a rotation A

  /// Returns m².
  std::size_t square() const { return at(moments) * at(moments); }
  /// Returns how many numbers a cell has.
  int numbers() const {
    return static_cast<int>(square()) * (5 * directions + (source ? 1 : 0) + (turns ? 4 : 0));
  }
  /// Returns the offset of ℛ v⁺ ∂E/∂ω for molecules that move to larger coordinates, or of ℛ v⁻ ∂E/∂ω
  /// for the others.
  std::size_t transport(int direction, bool up) const { return block(5 * direction + (up ? 0 : 1)); }
  /// Returns the offset of ℛ v G/σ of the deviation (tangent_rows::moments_of_deviation()).
  std::size_t deviation(int direction) const { return block(5 * direction + 2); }
  /// Returns the offset of the derivative of the flux to larger coordinates at an end of the gas next to the
  /// cell. The block is 0 if the gas does not end there.
  std::size_t end(const face& where) const { return block(5 * where.direction + (where.upper ? 4 : 3)); }
  /// Returns the offset of a derivative at the walls and ends of a group of cut cells, divided by the volume
  /// of the group. `weight` = 0 is the sum of the leaving fluxes. For 1 … directions this component of the
  /// vectors from the centroid weights the sum.
  std::size_t walls(int weight) const { return end(face_of(at(weight))); }
  /// Returns the offset of ℛ ∂S/∂ω.
  std::size_t of_source() const { return block(5 * directions); }
  /// Returns the direction of r.
  int radial() const { return directions - 1; }
  /// Returns the offset of ℛ A ∂E/∂ω.
  std::size_t turn() const { return of_turn(0); }
  /// Returns the offset of ℛ A G/σ of the deviation by the rotation.
  std::size_t turned_twice() const { return of_turn(1); }
  /// Returns the offset of ℛ v_r G/σ of the deviation by the rotation.
  std::size_t turned_then_moved() const { return of_turn(2); }
  /// Returns the offset of ℛ A G/σ of the deviation by the gradient along r.
  std::size_t moved_then_turned() const { return of_turn(3); }

 private:
  std::size_t of_turn(int number) const { return block(5 * directions + (source ? 1 : 0) + number); }
  std::size_t block(int number) const { return at(number) * square(); }
};

/// Computes the derivatives of fluxes, sources and boundary conditions with respect to ω in equilibrium,
/// cell by cell.
class cell_jacobian {
 public:
  /// All references must outlive the object.
  cell_jacobian(const relaxation_model& equation, const domain& space, const cell_links& links,
                const cut_links& cut, const inside_domain& acts);

  /// Returns the places of blocks in compute().
  const jacobian_layout& layout() const { return layout_; }
  /// Returns the blocks of all cells of this process, [cells][layout().numbers()]. The arguments are the
  /// moments ω and the collision rates σ = C/ε. Throws numerical_error with the cell if ω has no equilibrium.
  std::vector<double> compute(const std::vector<double>& omega, const std::vector<double>& rates) const;

 private:
  void differentiate_rotation(int cell, double rate, tangent_rows& tangents, double* blocks) const;
  void differentiate_source(int cell, const tangent_rows& tangents, double* matrix) const;

  const relaxation_model& equation_;
  const domain& space_;
  const cell_links& links_;
  const cut_links& cut_;
  const inside_domain& acts_;
  jacobian_layout layout_;
};

}  // namespace apsis
