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

/// A small case of a model with space: periodic, `cells` cells on [0, 2], 16 velocities in [−8, 8] if the
/// model has a velocity grid, its default data, and overrides "key=value".
case_config small_case(const std::string& model, const std::string& method, double epsilon, int cells,
                       const std::vector<std::string>& overrides);

/// Initial states, all nonnegative: the initial data, their local equilibrium, and `random` states in which
/// each cell, at random, has every unknown disturbed by a factor from 0.01 to 1, or all of them multiplied by
/// `vacuum`, or is in equilibrium; with `zeros`, a tenth of the disturbed unknowns is exactly 0.
std::vector<field> adversarial_states(case_problem& problem, int random, double vacuum, bool zeros);

/// Names of the models with space whose collisions decrease an entropy.
std::vector<std::string> all_entropy_models();

/// Σ_cells |cell| S(row); NaN if an unknown is negative.
double entropy_of(const run_setup& setup, const field& u);

/// Nonnegativity of all unknowns, in floating point.
kept_property<field> positivity();

/// Decay of the entropy. The rounding is that of a sum of some hundred terms of order one.
kept_property<field> entropy_decay(const run_setup& setup);

}  // namespace apsis
