#pragma once

#include <apsis/device/internal/sweep.hpp>
#include <apsis/device/internal/weno_edge.hpp>
#include <apsis/scheme/formulas/teno5.hpp>

namespace apsis::kernels {

/// Sweep with the edges of teno5.
struct sweep_teno5 : sweep<weno_edge<scalar::weights_teno>> {
  static constexpr const char* name = "sweep_teno5";  ///< name of the kernel
};

}  // namespace apsis::kernels
