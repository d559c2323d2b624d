#include <apsis/semidiscrete/global_integrals.hpp>

#include <apsis/exec/global_sum.hpp>

namespace apsis {

std::vector<double> global_integrals(const domain& space, std::span<const double> densities,
                                     std::size_t count) {
  std::vector<exact_sum> sums(count);
  for (std::size_t k = 0; k < densities.size(); ++k) {
    const int cell = static_cast<int>(k / count);
    const double share = space.mesh().solid(cell) < 0 ? space.mesh().gas_share(cell) : 1.0;
    sums[k % count].add(share * densities[k]);
  }
  std::vector<double> integrals = global_values(space.processes(), sums);
  for (double& one : integrals) one *= space.mesh().measure() * space.mesh().cell_volume();
  return integrals;
}

}  // namespace apsis
