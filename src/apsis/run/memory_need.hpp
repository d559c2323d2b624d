#pragma once

#include <apsis/run/setup.hpp>

namespace apsis {

/// Refuses a case that does not fit, before anything large is allocated: throws input_error if the buffers of
/// a step, `copies` further copies of the state and the snapshots of the fields need more memory than is
/// available (available_memory). What is small beside them is not counted, so a case that would fit is never
/// refused.
void check_memory(const case_config& config, const run_setup& setup, int copies);

}  // namespace apsis
