#pragma once

#include <string>

namespace apsis {

/// The instruction set that the kernels run with: the best that both they were compiled for and this
/// processor has (names of Highway: "SSE2", "AVX2", "AVX3" for AVX-512, …).
std::string kernel_instruction_set();

}  // namespace apsis
