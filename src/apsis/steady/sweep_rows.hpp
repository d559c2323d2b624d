#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace apsis {

/// The implicit upwind equations of one cell, for the instruction set of this processor.
namespace sweep_rows {

/// Components begin … end−1.
struct strip {
  int begin = 0, end = 0;
};

/// The terms of one direction, relative to λ = |v|/Δx: the factor of δ itself, and those of two upstream
/// rows.
struct upstream {
  double here = 1.0, first = 0.0, second = 0.0;
  const double *one = nullptr, *two = nullptr;
};

/// row ← the solution δ of (Σ_d λ_d here_d + rate) δ = row + Σ_d λ_d (first_d one_d + second_d two_d) for the
/// components of all strips; `lambda`: of every component, for 1 to 3 directions.
void solve(std::span<const upstream> terms, const std::array<const double*, 3>& lambda, double rate,
           std::span<const strip> strips, double* row);

}  // namespace sweep_rows
}  // namespace apsis
