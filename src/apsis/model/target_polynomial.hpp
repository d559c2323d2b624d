#pragma once

namespace apsis {

/// The polynomial P(c) = k + l·c + cᵀA c + (w·c)|c|² in the resolved components c = v − u. This header
/// includes nothing, because kernels of devices use it.
struct target_polynomial {
  double k = 1.0;       ///< k
  double l[3] = {},     ///< l
      w[3] = {};        ///< w
  double a[3][3] = {};  ///< A, symmetric

  /// Whether it has no term of third degree.
  constexpr bool is_quadratic() const { return w[0] == 0.0 && w[1] == 0.0 && w[2] == 0.0; }
};

/// A target without the correction that restores its moments.
struct target_shape {
  target_polynomial of_g,  ///< factor of g
      of_h;                ///< factor of h
  double variance = 1.0;   ///< variance of one resolved component of the base
};

}  // namespace apsis
