// Work and precision on the mixed-regime problem on cell averages that collide at centres, with the same
// kernels for all contestants.
#include "measure/table.hpp"
#include "peers/with_sundials/kinetic_races.hpp"

namespace apsis::bench::peers_mixed_centres_table {
namespace {

result_table measure(const settings& options) {
  auto result = peers::race_on_mixed_regime(peers::unknowns::averages_at_centres,
                                            {1e-3, 3e-4, 1e-4, 1e-5, 1e-6}, options);
  result.title = "Mixed-regime BGK on cell averages that collide at centres: work and precision";
  return result;
}

const registered here(
    {"peers-mixed-centres",
     "work and precision against SUNDIALS and SSP-RK3, mixed regime on averages, collisions at centres",
     measure});

}  // namespace
}  // namespace apsis::bench::peers_mixed_centres_table
