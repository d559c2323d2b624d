// Work and precision on Broadwell's model on point values, with the same kernels for all contestants.
#include "measure/table.hpp"
#include "peers/with_sundials/kinetic_races.hpp"

namespace apsis::bench::peers_broadwell_table {
namespace {

const registered here({"peers-broadwell",
                       "work and precision against SUNDIALS and explicit SSP methods, Broadwell's model",
                       peers::race_on_broadwell});

}  // namespace
}  // namespace apsis::bench::peers_broadwell_table
