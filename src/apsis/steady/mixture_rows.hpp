#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// One pass of Anderson's mixture over consecutive numbers, for the instruction set of this processor.
namespace mixture_rows {

/// Differences Δg_j of images, with their weights θ_j.
struct weighted_differences {
  std::vector<double> theta;        ///< θ_j
  std::vector<const double*> rows;  ///< number 0 of each difference
};

/// x ← factor (x + δ − Σ_j θ_j Δg_j) for the numbers first … first + count − 1, with the differences `now`.
/// newest[], if not null, first becomes x + δ − x / last_factor − Σ_j θ_j Δg_j with the differences `last`.
/// It may be a row of both `last` and `now`.
void move(std::size_t first, std::size_t count, const weighted_differences& last, double last_factor,
          double* newest, const weighted_differences& now, double factor, const double* delta, double* x);

}  // namespace mixture_rows
}  // namespace apsis
