#pragma once

#include <apsis/boundary/oblique_wall.hpp>
#include <apsis/mesh/face.hpp>
#include <apsis/velocity/position.hpp>
#include <apsis/velocity/velocity_set.hpp>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace apsis {

/// The rows on both sides of a face along one pencil.
struct pencil_end {
  /// Rows of the cells of the pencil, counted inwards from the face: as many as there are ghost rows, and at
  /// least three, if the pencil has so many.
  std::span<const double* const> inside;
  std::span<double* const> ghosts;  ///< rows to fill, counted outwards from the face
  const velocity_set& velocities;   ///< velocities of the components
  int components;                   ///< numbers of a row
  position at;                      ///< intersection of the pencil with the face
};

/// A boundary condition at a face of the domain: ghost rows for reconstruction and collision and, where it
/// prescribes them, the values of the incoming components at the face itself.
class boundary {
 public:
  virtual ~boundary() = default;

  /// Returns this boundary with tables for one face and the velocities of the domain, which the domain then
  /// uses in its place; nullptr, the default, if it needs none. Throws input_error if the boundary condition
  /// is not possible with these velocities.
  virtual std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const;
  /// Returns this boundary, as prepared, with the open area of its surface; the domain then uses it in place
  /// of this one. nullptr, the default: the condition does not depend on the area. `area` computes it: 1 on a
  /// line, a length in the plane, about an axis that of the rings. Throws input_error if the area is not
  /// possible.
  virtual std::shared_ptr<const boundary> on_surface(const std::function<double()>& area) const;
  /// Returns this condition for walls with any normal, with tables for the velocities of the domain; nullptr,
  /// the default, if it serves the faces of cells alone. Throws input_error as prepared() does.
  virtual std::shared_ptr<const oblique_wall> oblique(const velocity_set& velocities) const;
  /// Returns the cell, counted inwards from the face, whose row is used as ghost row `ghost` = 0, 1, …
  /// (counted outwards) of a pencil of `cells` cells; empty if fill() computes the row. Repeated rows are not
  /// copied.
  virtual std::optional<int> cell_of_ghost(int ghost, int cells) const;
  /// Fills the ghost rows of a pencil at time t. Called before every evaluation of T, and of Q if it depends
  /// on neighbouring cells, concurrently for different pencils.
  virtual void fill(const face& where, double t, const pencil_end& rows) const = 0;
  /// Whether incoming() gives the values of the components that enter through the face, for a pencil of
  /// `cells` cells with `ghosts` ghost rows. Transport then uses them in the fluxes in place of the edge
  /// values of ghost cells.
  virtual bool prescribes_incoming(int /*cells*/, int /*ghosts*/) const { return false; }
  /// For every component k that enters, incoming[k] ← its value at the face at time t. outgoing[k] is the
  /// value of a component that leaves, as it enters the flux v_k outgoing[k] of the step; 0 for others. The
  /// other components of incoming[], which does not overlap outgoing[], are free for scratch. Called
  /// concurrently for different pencils.
  virtual void incoming(const face& where, double t, const position& at, const double* outgoing,
                        double* incoming) const;
  /// The same for conditions that depend on the whole state inside: `ghosts` are the rows of fill(), counted
  /// outwards. Calls incoming() unless it is overridden.
  virtual void incoming_given_outgoing(const face& where, double t, const position& at,
                                       const double* outgoing, std::span<const double* const> ghosts,
                                       double* incoming) const;
  /// Returns the velocity of the wall, which does the work u_w · (force) on it; 0, the default, of a wall at
  /// rest and of an open end.
  virtual std::array<double, 3> wall_velocity(double /*t*/, const position& /*at*/) const { return {}; }
  /// Whether this is the axis of axisymmetric flow, r = 0.
  virtual bool is_axis() const { return false; }
  /// Returns the condition that a decorator applies; this object, the default, unless it is a decorator.
  virtual const boundary& undecorated() const { return *this; }
  /// Whether the domain continues at the opposite face; both faces of a direction must agree.
  virtual bool periodic() const { return false; }
  /// Returns c such that the entropy that enters through the face in a sweep of first order is at most Σ_k
  /// c_k F_k with the amounts F_k of the invariants that enter; {} means c = 0. Returns nothing, the default,
  /// if no such bound is known.
  virtual std::optional<std::vector<double>> entropy_bound() const { return std::nullopt; }
};

/// A boundary condition whose ghost rows are rows of interior cells.
class repeating_boundary : public boundary {
 public:
  /// Copies the repeated rows, for callers that need them in ghost rows.
  void fill(const face& where, double t, const pencil_end& rows) const final;
};

/// Returns the rows of the three cells next to an end, the nearest one first; the last one again where there
/// are fewer.
std::array<const double*, 3> three_inside(const pencil_end& rows);

/// A boundary condition that prescribes the incoming components. Ghost rows continue all components by the
/// quadratic through three cells inside. A smooth factor scales the continuation towards the cell at the face
/// where differences are larger than the value there and unequal, as next to a shock or a vacuum. The value
/// at the face enters only the flux: f has a layer of some mean free paths at a wall, and extrapolation
/// through the face would put this unresolved kink into interior stencils.
class incoming_boundary : public boundary {
 public:
  bool prescribes_incoming(int, int) const final { return true; }
  void fill(const face& where, double t, const pencil_end& rows) const final;
};

/// Returns v·n of every component, n being the normal of a face into the domain: positive for those that
/// enter.
std::vector<double> inward_speeds(const face& where, const velocity_set& velocities);
/// Returns 1 for components that enter the domain through a face, 0 for others.
std::vector<double> entering_components(const face& where, const velocity_set& velocities);

}  // namespace apsis
