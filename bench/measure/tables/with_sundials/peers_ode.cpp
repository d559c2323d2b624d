// Work and precision on the ODE model of the paper.
#include "measure/table.hpp"
#include "peers/with_sundials/stiff_contest.hpp"

namespace apsis::bench::peers_ode_table {
namespace {

result_table measure(const settings& options) {
  return peers::run(
      {"ODE model: work and precision",
       "The contest uses the ODE model of the paper with data out of equilibrium. The reference is "
       "extrapolated in extended precision to 1e-13.",
       peers::make_ode_model},
      options);
}

const registered here({"peers-ode",
                       "work and precision against other integrators, the ODE model of the paper", measure});

}  // namespace
}  // namespace apsis::bench::peers_ode_table
