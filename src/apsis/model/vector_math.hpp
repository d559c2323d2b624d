#pragma once

namespace apsis {

/// Number of doubles in the widest vector register. Loops over the points of a line work on whole packets of
/// this length.
inline constexpr int packet_length = 8;

}  // namespace apsis
