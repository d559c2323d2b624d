#pragma once

#include <apsis/output/result_folder.hpp>
#include <apsis/run/simulation.hpp>

#include <vector>

namespace apsis {

/// Adds surfaces/NAME.csv of every surface of output.surfaces (simulation::surfaces()) to the results, and in
/// the plane and in space surfaces/NAME.vtp for ParaView, in their units. Throws io_error.
void write_surfaces(const std::vector<surface_table>& surfaces, const case_config& config,
                    result_folder& folder);

}  // namespace apsis
