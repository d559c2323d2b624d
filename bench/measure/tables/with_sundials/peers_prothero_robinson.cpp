// Work and precision on Prothero and Robinson's problem.
#include "measure/table.hpp"
#include "peers/with_sundials/stiff_contest.hpp"

namespace apsis::bench::peers_prothero_robinson_table {
namespace {

result_table measure(const settings& options) {
  return peers::run(
      {"Prothero and Robinson's problem: work and precision",
       "Prothero and Robinson's problem is y' = φ'(t) + (φ(t) − y)/ε with φ = sin(π/4 + t). It starts "
       "from y = φ(0). Time is the first unknown, and φ' is T.",
       peers::make_prothero_robinson},
      options);
}

const registered here({"peers-prothero-robinson",
                       "work and precision against other integrators, Prothero and Robinson's problem",
                       measure});

}  // namespace
}  // namespace apsis::bench::peers_prothero_robinson_table
