#pragma once

#include <apsis/method/method.hpp>

#include <algorithm>
#include <cmath>

namespace apsis::test {

/// The smallest δ = |ḋ_i|, or d_i where ḋ_i = 0, of all stages that relax: with z = CΔt/ε such a stage is as
/// near to what the analysis for z → ∞ says as 1/(zδ).
inline double slowest_stage(const method& m) {
  const auto form = m.coefficients<double>();
  double slowest = 1.0;
  for (std::size_t i = 0; i < form.stages(); ++i) {
    const double size = form.ddot[i] != 0.0 ? std::abs(form.ddot[i]) : form.D(i, i);
    if (size > 0.0) slowest = std::min(slowest, size);
  }
  return slowest;
}

}  // namespace apsis::test
