#pragma once

namespace apsis {

/// Doubles that the widest vector register holds; these functions work on whole packets.
inline constexpr int packet_length = 8;

/// x[j] ← exp(x[j]) for j = 0 … n−1, n a multiple of packet_length, x aligned to 64 bytes; −700 ≤ x ≤ 700.
/// All elements go through the same instructions, so equal inputs give equal results wherever they stand.
void exp_packets(double* x, int n);

/// x[j] ← log(x[j]), likewise; x normal and positive.
void log_packets(double* x, int n);

}  // namespace apsis
