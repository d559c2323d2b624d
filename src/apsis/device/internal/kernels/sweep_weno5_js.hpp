#pragma once

#include <apsis/device/internal/sweep.hpp>
#include <apsis/device/internal/weno_edge.hpp>
#include <apsis/scheme/formulas/weno5_js.hpp>

namespace apsis::kernels {

/// Sweep with the edges of weno5-js.
struct sweep_weno5_js : sweep<weno_edge<scalar::weights_js>> {
  static constexpr const char* name = "sweep_weno5_js";  ///< name of the kernel
};

}  // namespace apsis::kernels
