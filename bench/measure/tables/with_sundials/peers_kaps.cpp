// Work and precision on Kaps' problem.
#include "measure/table.hpp"
#include "peers/with_sundials/stiff_contest.hpp"

namespace apsis::bench::peers_kaps_table {
namespace {

result_table measure(const settings& options) {
  return peers::run(
      {"Kaps' problem: work and precision",
       "Kaps' problem is u1' = u2 − u1 − u1² and u2' = −2u2 + (u1² − u2)/ε. It starts from (1, 1), near "
       "equilibrium. The solution is u1 = exp(−t) and u2 = u1².",
       peers::make_kaps},
      options);
}

const registered here({"peers-kaps", "work and precision against other integrators, Kaps' problem", measure});

}  // namespace
}  // namespace apsis::bench::peers_kaps_table
