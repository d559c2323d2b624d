#pragma once

#include <apsis/core/exact_sum.hpp>
#include <apsis/exec/communicator.hpp>

#include <span>
#include <vector>

namespace apsis {

/// Returns the values of sums over the terms of all processes, on every process. Collective. The results do
/// not depend on how the terms are distributed among processes.
std::vector<double> global_values(communicator& processes, std::span<exact_sum> sums);

/// Returns the smallest of the numbers of all processes. Collective.
double global_lowest(communicator& processes, double mine);

/// Returns the sum of integers over all processes. Collective.
std::int64_t global_count(communicator& processes, std::int64_t mine);

}  // namespace apsis
