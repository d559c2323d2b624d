#pragma once

#include <apsis/device/internal/sweep.hpp>
#include <apsis/device/internal/weno_edge.hpp>
#include <apsis/scheme/formulas/weno5_z.hpp>

namespace apsis::kernels {

/// Sweep with the edges of weno5-z.
struct sweep_weno5_z : sweep<weno_edge<scalar::weights_z>> {
  static constexpr const char* name = "sweep_weno5_z";  ///< name of the kernel
};

}  // namespace apsis::kernels
