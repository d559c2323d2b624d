#include <apsis/output/parallel_access.hpp>

#include <hdf5.h>
#include <mpi.h>

namespace apsis {

std::int64_t make_parallel_access(const communicator& processes) {
  const hid_t list = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_mpio(list, MPI_Comm_f2c(static_cast<MPI_Fint>(processes.handle())), MPI_INFO_NULL);
  return list;
}

std::int64_t make_collective_transfer() {
  const hid_t list = H5Pcreate(H5P_DATASET_XFER);
  H5Pset_dxpl_mpio(list, H5FD_MPIO_COLLECTIVE);
  return list;
}

}  // namespace apsis
