#pragma once

#include <string>

namespace apsis {

/// Returns the instruction set of the kernels: the best one that they are compiled for and this processor
/// supports (names of Highway: "SSE2", "AVX2", "AVX3" for AVX-512, …).
std::string kernel_instruction_set();

}  // namespace apsis
