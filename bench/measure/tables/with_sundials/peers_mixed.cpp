// Work and precision on the mixed-regime problem on cell averages, with the same kernels for all contestants.
#include "measure/table.hpp"
#include "peers/with_sundials/kinetic_races.hpp"

namespace apsis::bench::peers_mixed_table {
namespace {

result_table measure(const settings& options) {
  auto result = peers::race_on_mixed_regime(peers::unknowns::averages, {1e-3, 3e-4, 1e-4, 1e-5}, options);
  result.title = "Mixed-regime BGK on cell averages: work and precision";
  return result;
}

const registered here({"peers-mixed",
                       "work and precision against SUNDIALS and SSP-RK3, mixed regime on averages", measure});

}  // namespace
}  // namespace apsis::bench::peers_mixed_table
