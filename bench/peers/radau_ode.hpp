#pragma once

#include "radau_steps.hpp"
#include "stiff_task.hpp"

namespace apsis::bench::peers {

/// Runs Radau IIA of order 5. Its three stages are one dense system of six unknowns, without the
/// transformation that pays for larger systems.
outcome run_radau(const stiff_task& task, const radau_options& options);

}  // namespace apsis::bench::peers
