#pragma once

#include <apsis/exec/communicator.hpp>

#include <memory>

namespace apsis {

/// Whether this build of the library can run on several processes (CMake: APSIS_MPI).
bool has_mpi();

/// Returns the processes that a launcher such as mpirun or srun started together with this one, or a single
/// process without a launcher. Initializes MPI, and finalizes it when the last reference is gone. Throws
/// input_error if there are several processes and the library was built without MPI.
std::shared_ptr<communicator> launched_processes();

/// Returns the processes of an MPI communicator, given by its Fortran handle (MPI_Comm_c2f(comm) in C,
/// comm.py2f() in mpi4py), in a communicator of its own. MPI must be initialized, and finalized after the
/// last reference is gone. Throws input_error if the library was built without MPI, if MPI is not
/// initialized, or if the communicator is MPI_COMM_NULL.
std::shared_ptr<communicator> processes_of(int fortran_handle);

}  // namespace apsis
