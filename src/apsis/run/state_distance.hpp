#pragma once

#include <apsis/exec/communicator.hpp>
#include <apsis/mesh/field.hpp>

namespace apsis {

/// Returns ‖u − v‖₂/‖u‖₂ over all components of the cells of all processes; 0 where both are equal.
/// Collective; independent of the numbers of processes and threads.
double relative_distance(const field& u, const field& v, communicator& processes);

}  // namespace apsis
