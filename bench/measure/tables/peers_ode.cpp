// Work and precision on the ODE model of the paper.
#include "measure/table.hpp"
#include "peers/stiff_contest.hpp"

namespace apsis::bench::peers_ode_table {
namespace {

result_table measure(const settings& options) {
  auto result = peers::race_on(peers::make_ode_model, {1.0, 1e-2, 1e-4, 1e-6, 1e-10}, options);
  result.title = "ODE model: work and precision";
  result.note = std::string(
                    "The ODE model of the paper, data out of equilibrium. The reference is extrapolated in "
                    "extended precision to 1e-13.") +
                peers::race_note;
  return result;
}

const registered here({"peers-ode", "work and precision against other integrators, ODE model", measure});

}  // namespace
}  // namespace apsis::bench::peers_ode_table
