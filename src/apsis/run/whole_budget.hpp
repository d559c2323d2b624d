#pragma once

#include <apsis/run/setup.hpp>

#include <cstddef>
#include <vector>

namespace apsis {

/// Returns the amounts of a boundary_budget of the whole mesh on all processes, from the amounts of each.
/// They are in the order that a single process has. Empty if nothing was received. Collective.
std::vector<double> whole_budget(const run_setup& setup, const std::vector<double>& own);

/// Returns `count` numbers at each end of the whole mesh on all processes, from the numbers of each. They are
/// in the order of the budget. Collective.
std::vector<double> whole_ends(const run_setup& setup, const std::vector<double>& own, std::size_t count);

/// Returns the amounts of this process among those of the whole mesh.
std::vector<double> own_budget(const run_setup& setup, const std::vector<double>& whole);

/// Returns the number of amounts of the whole mesh.
std::size_t size_of_whole_budget(const run_setup& setup);

}  // namespace apsis
