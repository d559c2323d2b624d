// Work and precision on Kaps' problem.
#include "measure/table.hpp"
#include "peers/stiff_contest.hpp"

namespace apsis::bench::peers_kaps_table {
namespace {

result_table measure(const settings& options) {
  return peers::run({"Kaps' problem: work and precision",
                     "Kaps' problem, u1' = u2 − u1 − u1², u2' = −2u2 + (u1² − u2)/ε, from (1, 1), near "
                     "equilibrium; the solution is "
                     "u1 = exp(−t), u2 = u1².",
                     peers::make_kaps},
                    options);
}

const registered here({"peers-kaps", "work and precision against other integrators, Kaps' problem", measure});

}  // namespace
}  // namespace apsis::bench::peers_kaps_table
