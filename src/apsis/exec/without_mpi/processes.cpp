#include <apsis/exec/processes.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/launcher.hpp>

#include <fmt/format.h>

namespace apsis {

bool has_mpi() {
  return false;
}

std::shared_ptr<communicator> launched_processes() {
  if (const int count = launched_count(); count > 1)
    throw input_error(
        fmt::format("{} processes were started (this build has no MPI, so that each would run the whole "
                    "case); start one, or build with -DAPSIS_MPI=ON",
                    count));
  return single_process();
}

std::shared_ptr<communicator> processes_of(int) {
  throw input_error("an MPI communicator was given (this build has no MPI); build with -DAPSIS_MPI=ON");
}

}  // namespace apsis
