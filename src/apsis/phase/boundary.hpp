#pragma once

#include <apsis/phase/position.hpp>
#include <apsis/phase/velocity_set.hpp>

#include <optional>
#include <span>

namespace apsis {

/// A face of the domain: the lower or the upper end of a direction.
struct face {
  int direction = 0;   ///< 0, 1 or 2
  bool upper = false;  ///< at the largest coordinate
};

/// The rows on either side of a face, along one pencil.
struct pencil_end {
  std::span<const double* const> inside;  ///< of all cells of the pencil, counted inwards from the face
  std::span<double* const> ghosts;        ///< to be filled, counted outwards from the face
  const velocity_set& velocities;         ///< of the numbers of a row
  int components;                         ///< numbers of a row
  position at;                            ///< where the pencil meets the face
};

/// What lies beyond a face of the domain. Transport and collision see it through ghost rows only.
class boundary {
 public:
  virtual ~boundary() = default;

  /// The cell, counted inwards from the face, whose row is ghost row `ghost` = 0, 1, … (outwards) of a pencil
  /// of `cells` cells; empty where fill() has to compute the row. A repeated row is never copied.
  virtual std::optional<int> repeated_cell(int ghost, int cells) const;
  /// Fills the ghost rows of a pencil at time t. Called before every evaluation of T, and of Q where it needs
  /// neighbours, by any number of threads for different pencils.
  virtual void fill(const face& where, double t, const pencil_end& rows) const = 0;
  /// Whether the opposite face continues the domain; then both faces of the direction have to.
  virtual bool periodic() const { return false; }
  /// Whether no invariant enters or leaves through the face.
  virtual bool closed() const { return false; }
};

/// A boundary whose ghost rows are rows of cells inside.
class repeating_boundary : public boundary {
 public:
  /// Copies the repeated rows.
  void fill(const face& where, double t, const pencil_end& rows) const final;
};

}  // namespace apsis
