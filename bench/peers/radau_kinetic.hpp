#pragma once

#include "kinetic_task.hpp"
#include "radau_steps.hpp"

namespace apsis::bench::peers {

/// Runs Radau IIA of order 5 for T + Q/ε. As in RADAU5, the three stages are transformed to one real and one
/// complex system; both have sparse factors. The Jacobian is computed by differences of groups of columns
/// that share no row. The time limit is checked between steps.
outcome run_radau(kinetic_task& task, const radau_options& options, double seconds_allowed);

}  // namespace apsis::bench::peers
