#pragma once

#include <apsis/device/internal/sweep.hpp>
#include <apsis/device/internal/weno_edge.hpp>
#include <apsis/scheme/formulas/weno5_z.hpp>

namespace apsis::kernels {

/// Sweep with the edges of weno5-z-smooth.
struct sweep_weno5_z_smooth : sweep<weno_edge<scalar::weights_z_smooth>> {
  static constexpr const char* name = "sweep_weno5_z_smooth";  ///< name of the kernel
};

}  // namespace apsis::kernels
