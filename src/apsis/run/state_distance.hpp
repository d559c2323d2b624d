#pragma once

#include <apsis/device/device.hpp>
#include <apsis/exec/communicator.hpp>
#include <apsis/mesh/field.hpp>

namespace apsis {

/// Returns ‖u − v‖₂/‖u‖₂ over all components of the cells of all processes; 0 where both are equal.
/// Collective; independent of the numbers of processes and threads. `on`: the device that both live on; null
/// for the host.
double relative_distance(const field& u, const field& v, communicator& processes, device* on);

}  // namespace apsis
