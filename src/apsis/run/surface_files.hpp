#pragma once

#include <apsis/output/result_folder.hpp>
#include <apsis/run/simulation.hpp>

namespace apsis {

/// Adds surfaces/NAME.csv of every surface of output.surfaces to the results, in their units. Throws
/// io_error.
void write_surfaces(const simulation& run, result_folder& folder);

}  // namespace apsis
