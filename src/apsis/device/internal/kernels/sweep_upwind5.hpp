#pragma once

#include <apsis/device/internal/sweep.hpp>
#include <apsis/scheme/formulas/upwind.hpp>

namespace apsis::kernels {

/// Edges of upwind5.
struct upwind5_scheme {
  /// Returns the downstream edge value of the cell c; a … e are five cells in the direction of motion.
  static APSIS_FORMULA double edge(double a, double b, double c, double d, double e) {
    return scalar::upwind5_edge(a, b, c, d, e);
  }
};

/// Sweep with the edges of upwind5.
struct sweep_upwind5 : sweep<upwind5_scheme> {
  static constexpr const char* name = "sweep_upwind5";  ///< name of the kernel
};

}  // namespace apsis::kernels
