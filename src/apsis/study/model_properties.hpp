#pragma once

#include <apsis/model/model_registry.hpp>

#include <memory>
#include <vector>

namespace apsis {

/// A model of the registry with its default parameters; kinetic ones on 40 velocities in [−8, 8].
struct made_model {
  const model_entry* entry;         ///< of the registry
  std::unique_ptr<model> equation;  ///< never null
  /// `equation` if Q = C(ω)(E(ω) − u), else nullptr.
  const relaxation_model* relaxation;
};

/// Returns every model of the registry.
std::vector<made_model> all_models();
/// Returns every model of the registry with nonnegative unknowns, with collisions that keep them nonnegative.
/// Where the default collisions do not, it has tails = "nonnegative".
std::vector<made_model> nonnegative_models();

/// Defects of a state in Properties 3–5 of the paper; zero up to rounding.
struct relaxation_defects {
  double conservation;  ///< ‖ℛQ(u)‖ / (1 + ‖ℛu‖)   (Property 3)
  double equilibrium;   ///< ‖Q(E(ω))‖/‖E(ω)‖ and ‖ℛE(ω) − ω‖/(1 + ‖ω‖), the larger   (Property 4)
  double derivative;    ///< ‖Q'(u)Q(u) + C Q(u)‖ / ((1 + C)(1 + ‖u‖ + ‖Q‖))   (Property 5)
};

/// Returns the defects in maximum norms, with Q'(u)Q(u) by fourth-order differences of Q. Throws
/// numerical_error if u has no equilibrium.
relaxation_defects defects_of(const relaxation_model& m, const std::vector<double>& u);

/// Returns v = u + λ Q(v), a backward Euler step of the collision alone, solved as inside a stage. Throws
/// numerical_error if u has no equilibrium, or Newton's method finds no solution.
std::vector<double> backward_euler_on_collision(const model& m, const std::vector<double>& u, double lambda);

}  // namespace apsis
