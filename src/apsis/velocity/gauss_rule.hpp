#pragma once

#include <vector>

namespace apsis {

/// Nodes x_j in increasing order and weights w_j of ∫ f dx ≈ Σ w_j f(x_j). The rule is exact for polynomials
/// of degree up to 2n − 1 times exp(−x²/2). Dimensionless.
struct gauss_rule {
  std::vector<double> nodes,  ///< x_j
      weights;                ///< w_j, which include exp(x_j²/2)
};

/// Returns the rule of n points for the whole line. Throws input_error unless 4 ≤ n ≤ 300.
gauss_rule gauss_hermite(int n);

/// Returns the rule of n points for x > 0. A rule for both signs of x consists of two of them. Throws
/// input_error unless 2 ≤ n ≤ 60.
gauss_rule half_range_gauss_hermite(int n);

}  // namespace apsis
