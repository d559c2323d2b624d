#pragma once

namespace apsis {

/// Doubles that the widest vector register holds; loops over the points of a line work on whole packets.
inline constexpr int packet_length = 8;

}  // namespace apsis
