#pragma once

#include <apsis/boundary/domain.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// Returns the integrals over the whole mesh of `count` densities that are given in every cell of this
/// process, [cell][count]. Collective; independent of the numbers of processes and threads.
std::vector<double> global_integrals(const domain& space, std::span<const double> densities,
                                     std::size_t count);

}  // namespace apsis
