#pragma once

#include <apsis/device/device.hpp>
#include <apsis/exec/communicator.hpp>
#include <apsis/mesh/field.hpp>

namespace apsis {

/// Returns ‖u − v‖₂/‖u‖₂ over all components of the cells of all processes; 0 if both are equal. The result
/// does not depend on the numbers of processes and threads. `on` is the device on which both live; null for
/// the host. Collective.
double relative_distance(const field& u, const field& v, communicator& processes, device* on);

}  // namespace apsis
