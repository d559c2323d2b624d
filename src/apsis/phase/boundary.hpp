#pragma once

#include <apsis/phase/position.hpp>
#include <apsis/phase/velocity_set.hpp>

#include <memory>
#include <optional>
#include <span>

namespace apsis {

/// A face of the domain: the lower or the upper end of a direction.
struct face {
  int direction = 0;   ///< 0, 1 or 2
  bool upper = false;  ///< at the largest coordinate
};

/// The rows on both sides of a face along one pencil.
struct pencil_end {
  std::span<const double* const> inside;  ///< rows of all cells of the pencil, counted inwards from the face
  std::span<double* const> ghosts;        ///< rows to fill, counted outwards from the face
  const velocity_set& velocities;         ///< velocities of the components
  int components;                         ///< numbers of a row
  position at;                            ///< intersection of the pencil with the face
};

/// A boundary condition at a face of the domain. Transport and collision access it through ghost rows alone.
class boundary {
 public:
  virtual ~boundary() = default;

  /// Returns this boundary with tables for one face and the velocities of the domain, which the domain then
  /// uses in its place; nullptr, the default, if it needs none. Throws input_error if the boundary condition
  /// is not possible with these velocities.
  virtual std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const;
  /// Returns the cell, counted inwards from the face, whose row is used as ghost row `ghost` = 0, 1, …
  /// (counted outwards) of a pencil of `cells` cells; empty if fill() computes the row. Repeated rows are not
  /// copied.
  virtual std::optional<int> repeated_cell(int ghost, int cells) const;
  /// Fills the ghost rows of a pencil at time t. Called before every evaluation of T, and of Q if it depends
  /// on neighbouring cells, concurrently for different pencils.
  virtual void fill(const face& where, double t, const pencil_end& rows) const = 0;
  /// Whether the domain continues at the opposite face; both faces of a direction must agree.
  virtual bool periodic() const { return false; }
  /// Whether no invariant crosses the face.
  virtual bool closed() const { return false; }
};

/// A boundary condition whose ghost rows are rows of interior cells.
class repeating_boundary : public boundary {
 public:
  /// Copies the repeated rows, for callers that need them in ghost rows.
  void fill(const face& where, double t, const pencil_end& rows) const final;
};

}  // namespace apsis
