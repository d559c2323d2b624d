#pragma once

#include <cstddef>
#include <span>

namespace apsis {

/// Checks of a model that are faster for several rows together than row by row, such as those that evaluate
/// formulas of a case. A model with such checks derives from this class too.
class checks_of_rows {
 public:
  virtual ~checks_of_rows() = default;

  /// scales ← model::invariant_scales() of `rows` rows. Densities and scales of a row follow those of the
  /// previous row.
  virtual void invariant_scales_of_rows(std::span<const double> densities, int rows,
                                        double* scales) const = 0;
  /// Returns the number of rows, `pitch` numbers apart, before the first that model::check_supported()
  /// refuses; `rows` if it refuses none.
  virtual int first_unsupported(const double* u, std::ptrdiff_t pitch, int rows) const = 0;
};

}  // namespace apsis
