#pragma once

#include "kinetic_task.hpp"
#include "radau_steps.hpp"

namespace apsis::bench::peers {

/// Runs Radau IIA of order 5 for T + Q/ε with RADAU5's transformation of the three stages to one real and one
/// complex system, sparse factors of both, and a Jacobian by differences of groups of columns that share no
/// row. The time limit is checked between steps.
outcome run_radau(kinetic_task& task, const radau_options& options, double seconds_allowed);

}  // namespace apsis::bench::peers
