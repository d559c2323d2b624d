#pragma once

#include <apsis/device/internal/sweep.hpp>
#include <apsis/scheme/formulas/upwind.hpp>

namespace apsis::kernels {

/// Edges of upwind1.
struct upwind1_scheme {
  /// Returns the downstream edge value of the cell c; a … e are five cells in the direction of motion.
  static APSIS_FORMULA double edge(double, double, double c, double, double) {
    return scalar::upwind1_edge(c);
  }
};

/// Sweep with the edges of upwind1.
struct sweep_upwind1 : sweep<upwind1_scheme> {
  static constexpr const char* name = "sweep_upwind1";  ///< name of the kernel
};

}  // namespace apsis::kernels
