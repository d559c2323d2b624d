// Work and precision on the mixed-regime problem on point values, with the same kernels for all contestants.
#include "measure/table.hpp"
#include "peers/with_sundials/kinetic_races.hpp"

namespace apsis::bench::peers_mixed_points_table {
namespace {

result_table measure(const settings& options) {
  auto result = peers::race_on_mixed_regime(peers::unknowns::points, {1e-3, 3e-4, 1e-4, 1e-5, 1e-6}, options);
  result.title = "Mixed-regime BGK on point values: work and precision";
  return result;
}

const registered here({"peers-mixed-points",
                       "work and precision against SUNDIALS and SSP-RK3, mixed regime on point values",
                       measure});

}  // namespace
}  // namespace apsis::bench::peers_mixed_points_table
