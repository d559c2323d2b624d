#pragma once

#include <apsis/config/case.hpp>
#include <apsis/mesh/grid.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Returns warnings about the bodies of a case in its whole mesh:
/// - parts of them that are cut off, because they end between the corners of a cell;
/// - bodies of fewer than 3 cells across, with the cells that they need;
/// - bodies that an open end cuts. A body may reach an end on purpose, like the wall of a channel. It counts
///   as cut if it touches a single face, or if the case has a table [output.reference].
std::vector<std::string> warnings_of_bodies(const case_config& config, const grid& mesh);

}  // namespace apsis
