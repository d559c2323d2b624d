#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/model/model.hpp>
#include <apsis/scheme/reconstruction.hpp>
#include <apsis/semidiscrete/cell_unknown.hpp>
#include <apsis/semidiscrete/collision.hpp>
#include <apsis/semidiscrete/transport.hpp>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// The parts from which the operators T and Q of a problem are made.
struct problem_parts {
  const model& equation;                             ///< outlives the operators
  std::shared_ptr<domain> space;                     ///< cells and ghost rows
  std::shared_ptr<const reconstruction> scheme;      ///< null without space
  bool limited = false;                              ///< with a positivity limiter
  bool smooth_collisions = false;                    ///< collisions need not keep signs
  std::string collisions;                            ///< one of collision_places(); "" for the default
  stage_solution stages = stage_solution::implicit;  ///< what the collision solves
  /// Returns ε at points of every cell, [cells][points].
  std::function<std::vector<double>(std::span<const weighted_point> points)> epsilon_at;

  /// Whether the reconstruction is first-order upwind, which keeps signs without a limiter.
  bool first_order() const { return scheme && scheme->order() == 1; }
  /// Whether steps within r Δt_FE keep nonnegative data nonnegative.
  bool keeps_sign() const { return limited || first_order() || !scheme; }
};

/// Where cells collide, and what a collision needs of their neighbours.
struct collision_layout {
  std::span<const weighted_point> points;  ///< points of every cell, with the weights of ∫ Q dx
  bool cellwise = true;                    ///< no collision depends on another cell
  int reach = 0;  ///< neighbours on either side whose averages give values at the points; 0 if a
                  ///< reconstruction gives them
};

/// A discretization of space: what the unknown of a cell is, and the operators T and Q on these unknowns. It
/// has no state; an entry of the registry (discretization_registry.hpp).
class discretization {
 public:
  virtual ~discretization() = default;

  /// Returns what the number of a cell and component stands for.
  virtual const cell_unknown& unknown() const = 0;
  /// Returns why meshes need one dimension, as a clause: "cell averages collide at …"; "" if they do not.
  virtual std::string why_on_a_line() const { return ""; }
  /// Returns why meshes cannot have solid boxes, as such a clause; "" if they can.
  virtual std::string why_without_solids() const { return ""; }

  /// Returns the choices of where cells collide, the default first; empty without a choice.
  virtual std::vector<std::string> collision_places() const { return {}; }
  /// Returns where cells collide for one of these choices, or "".
  virtual collision_layout collisions_at(const std::string& place, const reconstruction& scheme) const = 0;

  /// Returns κ of Δt_FE = κ / max Σ_k |v_k|/Δx_k with the positivity limiter and collisions at a place, or
  /// "", with a reconstruction of order 2 or more.
  virtual double limited_cfl_number(const std::string& place) const = 0;

  /// Returns T without force and source. It reserves the ghost rows that it needs.
  virtual std::unique_ptr<transport> make_transport(const problem_parts& of) const = 0;
  /// Returns Q/ε. It reserves the ghost rows that it needs.
  virtual std::unique_ptr<collision> make_collision(const problem_parts& of) const = 0;
};

}  // namespace apsis
