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

/// The parts of a problem from which the operators T and Q are made.
struct problem_parts {
  const model& equation;                             ///< outlives the operators
  std::shared_ptr<domain> space;                     ///< cells and ghost rows
  std::shared_ptr<const reconstruction> scheme;      ///< null without space
  bool limited = false;                              ///< whether a positivity limiter acts
  bool smooth_collisions = false;                    ///< whether collisions need not preserve signs
  std::string collisions;                            ///< one of collision_places(); "" for the default
  stage_solution stages = stage_solution::implicit;  ///< equation that the collision solves
  /// Returns ε at points of every cell, [cells][points].
  std::function<std::vector<double>(std::span<const weighted_point> points)> epsilon_at;

  /// Returns true if the reconstruction is first-order upwind, which preserves signs without a limiter.
  bool first_order() const { return scheme && scheme->order() == 1; }
  /// Returns true if steps within r Δt_FE keep nonnegative data nonnegative.
  bool keeps_sign() const { return limited || first_order() || !scheme; }
};

/// The points at which cells collide, and the neighbours that this needs.
struct collision_layout {
  std::span<const weighted_point> points;  ///< points of every cell, with the weights of ∫ Q dx
  bool cellwise = true;                    ///< whether no collision depends on another cell
  int reach = 0;  ///< neighbours on each side whose averages give the values; 0 for a reconstruction
};

/// A discretization of space: the meaning of the unknown of a cell, and the operators T and Q on these
/// unknowns. It has no state and is an entry of the registry (discretization_registry.hpp).
class discretization {
 public:
  virtual ~discretization() = default;

  /// Returns the meaning of the unknown of a cell and component.
  virtual const cell_unknown& unknown() const = 0;
  /// Returns a clause with the reason why meshes need one dimension: "cell averages collide at …"; "" if
  /// they do not.
  virtual std::string why_on_a_line() const { return ""; }
  /// Returns such a clause with the reason why meshes cannot have solid boxes; "" if they can.
  virtual std::string why_without_solids() const { return ""; }

  /// Returns the names of the places at which cells may collide, the default first; empty without a choice.
  virtual std::vector<std::string> collision_places() const { return {}; }
  /// Returns the layout of collisions at one of these places, or at the default for "".
  virtual collision_layout collisions_at(const std::string& place, const reconstruction& scheme) const = 0;

  /// Returns κ of Δt_FE = κ / max Σ_k |v_k|/Δx_k with the positivity limiter and a reconstruction of order 2
  /// or more. `place` is that of the collisions, or "".
  virtual double limited_cfl_number(const std::string& place) const = 0;

  /// Returns T without force and source. The operator reserves its ghost rows.
  virtual std::unique_ptr<transport> make_transport(const problem_parts& of) const = 0;
  /// Returns Q/ε. The operator reserves its ghost rows.
  virtual std::unique_ptr<collision> make_collision(const problem_parts& of) const = 0;
};

}  // namespace apsis
