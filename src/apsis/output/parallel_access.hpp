#pragma once

#include <apsis/exec/communicator.hpp>

#include <cstdint>

namespace apsis {

/// Returns a new HDF5 file access property list, which the caller closes, for files that several processes
/// write together. Throws input_error if the library was built without MPI.
std::int64_t make_parallel_access(const communicator& processes);

/// Returns a new transfer property list, which the caller closes, with which all processes write a dataset
/// together.
std::int64_t make_collective_transfer();

}  // namespace apsis
