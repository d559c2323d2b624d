#pragma once

#include <apsis/method/method.hpp>

#include <vector>

namespace apsis {

/// Whether the first `rows` rows of the Shu–Osher form are convex combinations of forward Euler steps of T
/// and implicit steps of Q. Explicit methods have forward Euler steps of T and Q. Under this hypothesis of
/// the paper's theorems, r is an SSP coefficient.
template <class Real>
bool is_convex(const shu_osher_form<Real>& m, method_kind kind, std::size_t rows) {
  const auto initial = initial_weights(m);
  for (std::size_t i = 0; i < rows; ++i) {
    if (initial[i] < Real(0) || m.D(i, i) < Real(0) || m.ddot[i] > Real(0)) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (m.P(i, j) < Real(0) || m.W(i, j) < Real(0)) return false;
      if (kind != method_kind::explicit_only && m.D(i, j) != Real(0)) return false;
    }
  }
  return true;
}

}  // namespace apsis
