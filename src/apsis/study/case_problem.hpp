#pragma once

#include <apsis/run/setup.hpp>
#include <apsis/verify/strong_stability.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// The semi-discrete problem of a case, for largest_step.
struct case_problem {
  /// Throws as run_setup does.
  explicit case_problem(const case_config& config) : setup(config), equations(setup.make_problem()) {}

  run_setup setup;                                  ///< model, mesh and initial data
  std::unique_ptr<semidiscrete_problem> equations;  ///< T and Q, which refer to `setup`
};

/// Returns a small periodic case of a model with space: `cells` cells on [0, 2], the default data of the
/// model, and `overrides` "key=value". If the model has a velocity grid, it has 16 velocities in [−8, 8].
case_config small_case(const std::string& model, const std::string& method, double epsilon, int cells,
                       const std::vector<std::string>& overrides);

/// Returns nonnegative initial states: the initial data, their local equilibrium, and `random` disturbed
/// states. In each cell of a disturbed state, one of three changes is made at random. Every unknown is
/// multiplied by a factor from 0.01 to 1, or all are multiplied by `vacuum`, or the cell is set to
/// equilibrium. With `zeros`, a tenth of the unknowns is exactly 0, except in equilibrium.
std::vector<field> adversarial_states(case_problem& problem, int random, double vacuum, bool zeros);

/// Returns the names of the models with space whose collisions decrease an entropy.
std::vector<std::string> all_entropy_models();

/// Returns Σ_cells |cell| S(row); NaN if an unknown is negative.
double entropy_of(const run_setup& setup, const field& u);

/// Returns the nonnegativity of all unknowns, in floating point.
kept_property<field> positivity();

/// Returns the decay of the entropy. Its tolerance covers the rounding of a sum of some hundred
/// terms of order one.
kept_property<field> entropy_decay(const run_setup& setup);

}  // namespace apsis
