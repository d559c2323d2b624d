#pragma once

#include <string>

namespace apsis {

/// Returns the instruction set of the kernels: the best one that was compiled and that this processor
/// supports. Names are those of Highway: "SSE2", "AVX2", "AVX3" for AVX-512, …
std::string kernel_instruction_set();

}  // namespace apsis
