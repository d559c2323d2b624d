#pragma once

#include <apsis/steady/continuation.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// Continuation in the incoming components at walls and open ends, and thus in temperatures and
/// velocities of walls:
///   f_in = s g + (1 − s) c M,   s = 1/64, 1/32, …, 1/2.
/// g is that of the boundary condition, and M is the equilibrium of the mean moments of the start. The factor
/// c gives M the mass flux of g, so that no mass crosses a wall. A wall of temperature T in a gas of T₀ emits
/// the same energy as one with s T + (1 − s) T₀. It emits the same momentum as one with s u + (1 − s) u₀. The
/// mixture is nonnegative if g is.
class milder_ends final : public continuation {
 public:
  /// Returns true if the model is a gas and some boundary prescribes incoming components.
  static bool possible(const relaxation_model& equation, const problem_builder& space);

  /// All references but `start` must outlive the object. Collective.
  milder_ends(const relaxation_model& equation, const problem_builder& space, const field& start, int images);

  std::string name() const override;

 private:
  problem_builder problem(std::size_t number) const override;
  std::string name_of(std::size_t number) const override;

  std::shared_ptr<const problem_builder> space_;
  std::shared_ptr<const std::vector<double>> row_;  ///< M
};

/// Returns the boundary condition f_in = s g + (1 − s) c M of milder_ends, with g of the condition `of`.
/// `row` is M; the components of its first set determine the mass.
std::shared_ptr<const boundary> milder_end(std::shared_ptr<const boundary> of, double share,
                                           std::shared_ptr<const std::vector<double>> row);

}  // namespace apsis
