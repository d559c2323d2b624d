#pragma once

#include <apsis/boundary/domain.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// Returns the integrals of `count` densities over the whole mesh, from their values in every cell of this
/// process, [cell][count]. Collective. The result does not depend on the numbers of processes and threads.
std::vector<double> global_integrals(const domain& space, std::span<const double> densities,
                                     std::size_t count);

}  // namespace apsis
