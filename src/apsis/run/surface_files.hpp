#pragma once

#include <apsis/output/result_folder.hpp>
#include <apsis/run/simulation.hpp>

#include <vector>

namespace apsis {

/// Adds surfaces/NAME.csv of every surface of output.surfaces (simulation::surfaces()) to the results. In
/// the plane and in space it also adds surfaces/NAME.vtp for ParaView. Numbers are in the units of the
/// results. Throws io_error.
void write_surfaces(const std::vector<surface_table>& surfaces, const case_config& config,
                    result_folder& folder);

}  // namespace apsis
