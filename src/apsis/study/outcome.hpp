#pragma once

#include <apsis/run/simulation.hpp>
#include <apsis/study/study_control.hpp>

#include <string>
#include <vector>

namespace apsis {

/// A completed run.
struct outcome {
  case_config config;             ///< resolved case
  run_summary summary;            ///< totals of its steps
  field_table fields;             ///< macroscopic fields at the end
  int cells = 0,                  ///< number of cells of the mesh; 1 without space
      components = 0;             ///< unknowns of a cell
  std::vector<double> state;      ///< [cells][components]
  std::vector<double> exact;      ///< the exact solution in the same form; empty if unknown
  double cell_volume = 1.0;       ///< 1 without space
  double component_weight = 1.0;  ///< weight of a component in norms: the velocity cell Δv^d, or 1
};

/// Runs a case to its end. Throws the errors of a simulation, and study_interrupted between steps.
outcome compute_outcome(const case_config& config, const study_control& control = {});

/// Runs the built-in case or file `name` with overrides "key=value", as compute_outcome() of a case does.
outcome compute_outcome(const std::string& name, const std::vector<std::string>& overrides,
                        const study_control& control = {});

}  // namespace apsis
