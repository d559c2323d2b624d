// Work and precision on Prothero and Robinson's problem.
#include "measure/table.hpp"
#include "peers/stiff_contest.hpp"

namespace apsis::bench::peers_prothero_robinson_table {
namespace {

result_table measure(const settings& options) {
  auto result = peers::race_on(peers::make_prothero_robinson, {1.0, 1e-2, 1e-4, 1e-6, 1e-10}, options);
  result.title = "Prothero and Robinson's problem: work and precision";
  result.note =
      std::string(
          "Prothero and Robinson's problem y' = φ'(t) + (φ(t) − y)/ε with φ = sin(π/4 + t), from y = φ(0); "
          "time is the first unknown, φ' is T.") +
      peers::race_note;
  return result;
}

const registered here({"peers-prothero-robinson",
                       "work and precision against other integrators, Prothero and Robinson's problem",
                       measure});

}  // namespace
}  // namespace apsis::bench::peers_prothero_robinson_table
