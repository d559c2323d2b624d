#pragma once

#include <apsis/exec/number.hpp>
#include <apsis/scheme/formulas/weno5.hpp>

namespace apsis::kernels {

/// Downstream edge value of a cell by a WENO scheme with these weights (scheme/formulas/weno5.hpp).
template <class Weights>
struct weno_edge {
  /// Returns the downstream edge value of the cell c; a … e are five cells in the direction of motion.
  static APSIS_FORMULA double edge(double a, double b, double c, double d, double e) {
    using namespace scalar::weno5;
    const window<Weights, double> u(a, b, c, d, e);
    // NOLINTNEXTLINE(misc-const-correctness): weights for all sizes do not change it.
    right_fraction<double> cell(edge_terms<Weights, double>{u});
    if constexpr (!Weights::of_any_size)
      cell.replace_if_too_large(right_fraction<double>(edge_terms<scaled<Weights>, double>(u)));
    return cell.edge();
  }
};

}  // namespace apsis::kernels
