#pragma once

namespace apsis {

/// Doubles that the widest vector register holds; line_sums and line_family work on whole packets.
inline constexpr int packet_length = 8;

}  // namespace apsis
