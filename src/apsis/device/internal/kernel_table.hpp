#pragma once

#include <apsis/device/lane_team.hpp>

#include <span>

namespace apsis {

/// A kernel compiled for the host.
struct host_kernel {
  const char* name;                                           ///< name of the kernel
  std::size_t bytes_of_arguments;                             ///< size of its arguments
  void (*run)(const team_lane& lane, const void* arguments);  ///< runs one lane
};

/// Returns all kernels of device/internal/kernels/ (generated).
std::span<const host_kernel> host_kernels();

/// Code of all kernels for one kind of processor.
struct device_code_object {
  const char* processor;      ///< "sm_70", "gfx90a"
  const unsigned char* code;  ///< PTX that ends with 0, or an ELF file
  std::size_t bytes;          ///< size of the code
};

/// Returns the code for graphics processors, oldest processor first; empty if the build had no compiler for
/// them (generated).
std::span<const device_code_object> device_code_objects();

}  // namespace apsis
