#pragma once

#include <apsis/device/device.hpp>
#include <apsis/device/lane_team.hpp>

#include <memory>

namespace apsis {

/// Returns a device whose kernels run on the host, lane by lane, for tests. Its memory is separate from that
/// of the host, and initially NaN.
std::unique_ptr<device> make_team_device(lane_order order);

}  // namespace apsis
