#pragma once

#include <apsis/run/setup.hpp>

namespace apsis {

/// Throws input_error, before anything large is allocated, if the buffers of a step, `copies` additional
/// copies of the state and the snapshots of the fields exceed the available memory (available_memory).
/// Smaller allocations are not counted, so that a case that fits is never refused.
void check_memory(const case_config& config, const run_setup& setup, int copies);

}  // namespace apsis
