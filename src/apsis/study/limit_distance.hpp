#pragma once

#include <apsis/config/case.hpp>
#include <apsis/study/report_table.hpp>
#include <apsis/study/study_control.hpp>

#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// Initial data of a study of the limit.
enum class limit_start {
  given,       ///< as the case gives them
  equilibrium  ///< their local equilibrium
};

/// Distances of one run from the limit scheme, after the first step and at the end. A distance is the largest
/// difference, relative to the largest reference value.
struct limit_row {
  double epsilon = 0.0;        ///< ε of the run
  double moments_first = 0.0,  ///< ω against the moments of the limit scheme, after the first step
      moments_end = 0.0;       ///< ω against the moments of the limit scheme, at the end
  double state_first = 0.0,    ///< u against the equilibrium of the limit scheme, after the first step
      state_end = 0.0;         ///< u against the equilibrium of the limit scheme, at the end
};

/// Distances of the runs of one case from the limit scheme as ε decreases.
struct limit_table {
  std::string model,             ///< model.name
      method,                    ///< time.method
      discretization;            ///< "finite volume" or "finite difference"; "" without space
  double dt = 0.0;               ///< first step of the run with the first ε
  long steps = 0;                ///< number of its steps
  double off_equilibrium = 0.0;  ///< distance of the initial data from their local equilibrium
  std::vector<limit_row> rows;   ///< in the order of the given epsilons

  /// Returns the distance at the smallest ε; NaN without rows.
  double floor(double limit_row::* column) const;
  /// Returns the least-squares slope of log distance against log ε. It uses the rows with ε < Δt/10 whose
  /// distance is above `round_off`; empty for fewer than three such rows.
  std::optional<double> slope(double limit_row::* column, double round_off = 1e-12) const;
  /// Returns one line per ε, followed by the slopes.
  report_table report() const;
};

/// Runs the case through the production code with each ε in place of its own, and the limit scheme with the
/// same steps. The limit scheme starts from the same data. They are projected to their local equilibrium
/// unless the first stage of the method does this. Throws the errors of a simulation and of limit_scheme.
limit_table limit_distance(const case_config& config, const std::vector<double>& epsilons,
                           limit_start start = limit_start::given, const study_control& control = {});

/// Returns `count` numbers in geometric progression from `first` to `last`.
std::vector<double> geometric(double first, double last, int count);

}  // namespace apsis
