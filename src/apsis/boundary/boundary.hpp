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
  /// Rows of the cells of the pencil, counted inwards from the face. There are as many as ghost rows, but at
  /// least three. Only a pencil with fewer cells has fewer.
  std::span<const double* const> inside;
  std::span<double* const> ghosts;  ///< rows to fill, counted outwards from the face
  const velocity_set& velocities;   ///< velocities of the components
  int components;                   ///< numbers of a row
  position at;                      ///< intersection of the pencil with the face
};

/// A boundary condition at a face of the domain. It fills ghost rows for reconstruction and collision. It may
/// also prescribe the values of the incoming components at the face itself.
class boundary {
 public:
  virtual ~boundary() = default;

  /// Returns this boundary with tables for one face and the velocities of the domain; the domain then uses
  /// the result instead of this object. Returns nullptr, the default, if no tables are needed. Throws
  /// input_error if the boundary condition is not possible with these velocities.
  virtual std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const;
  /// Returns this prepared boundary with the open area of its surface; the domain then uses the result
  /// instead of this object. Returns nullptr, the default, if the condition does not depend on the area.
  /// `area` computes the area: 1 on a line, a length in the plane, the area of the rings about an axis.
  /// Throws input_error if the area is not possible.
  virtual std::shared_ptr<const boundary> on_surface(const std::function<double()>& area) const;
  /// Returns this condition for walls with any normal, with tables for the velocities of the domain.
  /// Returns nullptr, the default, if the condition serves only the faces of cells. Throws input_error
  /// as prepared() does.
  virtual std::shared_ptr<const oblique_wall> oblique(const velocity_set& velocities) const;
  /// Returns the cell whose row is used as ghost row `ghost` = 0, 1, … of a pencil of `cells` cells; empty if
  /// fill() computes the row. Cells are counted inwards and ghost rows outwards from the face. Repeated rows
  /// are not copied.
  virtual std::optional<int> cell_of_ghost(int ghost, int cells) const;
  /// Returns x if the first ghost row of a pencil is x times the row of its first cell, for every row; else
  /// 0. `at` is the end of the pencil.
  virtual double multiple_of_cell(const face& /*where*/, const position& /*at*/, int cells) const {
    return cell_of_ghost(0, cells) == 0 ? 1.0 : 0.0;
  }
  /// Fills the ghost rows of a pencil at time t. Called before every evaluation of T, and of Q if Q depends
  /// on neighbouring cells. Calls for different pencils are concurrent.
  virtual void fill(const face& where, double t, const pencil_end& rows) const = 0;
  /// Returns true if incoming() gives the values of the components that enter through the face, for a pencil
  /// of `cells` cells with `ghosts` ghost rows. Transport then uses these values in the fluxes instead of the
  /// edge values of ghost cells.
  virtual bool prescribes_incoming(int /*cells*/, int /*ghosts*/) const { return false; }
  /// incoming[k] ← the value at the face at time t, for every component k that enters. outgoing[k] is the
  /// value in the flux v_k outgoing[k] of the step for a component that leaves, and 0 for others. The
  /// remaining components of incoming[] are free for scratch. The two arrays do not overlap. Calls for
  /// different pencils are concurrent.
  virtual void incoming(const face& where, double t, const position& at, const double* outgoing,
                        double* incoming) const;
  /// Does the same for conditions that depend on the whole state inside. `ghosts` are the rows of fill(),
  /// counted outwards. The default calls incoming().
  virtual void incoming_given_outgoing(const face& where, double t, const position& at,
                                       const double* outgoing, std::span<const double* const> ghosts,
                                       double* incoming) const;
  /// Returns the velocity u_w of the wall, which does the work u_w · (force) on the wall. The default is 0,
  /// for a wall at rest and an open end.
  virtual std::array<double, 3> wall_velocity(double /*t*/, const position& /*at*/) const { return {}; }
  /// Returns true if this is the axis r = 0 of axisymmetric flow.
  virtual bool is_axis() const { return false; }
  /// Returns the condition that a decorator applies; this object, the default, unless it is a decorator.
  virtual const boundary& undecorated() const { return *this; }
  /// Returns true if the domain continues at the opposite face; both faces of a direction must agree.
  virtual bool periodic() const { return false; }
  /// Returns the coefficients c of an entropy bound. In a sweep of first order the entropy that enters
  /// through the face is at most Σ_k c_k F_k, with the amounts F_k of the invariants that enter. {} means c =
  /// 0. Returns nothing, the default, if no such bound is known.
  virtual std::optional<std::vector<double>> entropy_bound() const { return std::nullopt; }
};

/// A boundary condition whose ghost rows are rows of interior cells.
class repeating_boundary : public boundary {
 public:
  /// Copies the repeated rows into ghost rows, for callers that need them there.
  void fill(const face& where, double t, const pencil_end& rows) const final;
};

/// Returns the rows of the three cells next to an end, the nearest one first. The last row is repeated if
/// there are fewer cells.
std::array<const double*, 3> three_inside(const pencil_end& rows);

/// A boundary condition that prescribes the incoming components. Ghost rows continue all components by the
/// quadratic through three cells inside. Next to a shock or a vacuum, differences may be unequal and larger
/// than the value of the cell at the face. A smooth factor then scales the continuation towards this value.
/// The prescribed value enters only the flux. At a wall f has a layer of some mean free paths, and
/// extrapolation through the face would put this unresolved kink into interior stencils.
class incoming_boundary : public boundary {
 public:
  bool prescribes_incoming(int, int) const final { return true; }
  void fill(const face& where, double t, const pencil_end& rows) const final;
};

/// Returns v·n of every component with the normal n of a face into the domain. It is positive for
/// components that enter.
std::vector<double> inward_speeds(const face& where, const velocity_set& velocities);
/// Returns 1 for components that enter the domain through a face, 0 for others.
std::vector<double> entering_components(const face& where, const velocity_set& velocities);

}  // namespace apsis
