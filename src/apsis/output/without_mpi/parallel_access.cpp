#include <apsis/output/parallel_access.hpp>

#include <apsis/core/errors.hpp>

namespace apsis {
namespace {

[[noreturn]] void refuse() {
  throw input_error("a file of several processes (this build has no MPI); build with -DAPSIS_MPI=ON");
}

}  // namespace

std::int64_t make_parallel_access(const communicator&) {
  refuse();
}

std::int64_t make_collective_transfer() {
  refuse();
}

}  // namespace apsis
