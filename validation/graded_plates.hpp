#pragma once

#include <map>
#include <string>
#include <vector>

namespace apsis::validation {

/// Cells between plates at x = 0 and 1 that are thinner at the plates. A steady flow depends on x only
/// through s with ds/dx ∝ 1/ε(x). Uniform cells in x, with an ε that grows towards the plates, are therefore
/// graded cells in s:
///     s(x) = b x + (1 − b)(3x² − 2x³),   ε = ε₀/s'(x).
/// A force per length in s is s'(x) times as large in x.
class graded_plates {
 public:
  /// b: ratio of the widths in s and in x of the cells at the plates, in (0, 1].
  explicit graded_plates(double b) : b_(b) {}

  /// Returns s at x.
  double place(double x) const { return b_ * x + (1.0 - b_) * x * x * (3.0 - 2.0 * x); }
  /// Returns s' at x.
  double slope(double x) const { return b_ + 6.0 * (1.0 - b_) * x * (1.0 - x); }
  /// Returns s as a formula of a case.
  std::string place_formula() const;
  /// Returns s' as a formula of a case.
  std::string slope_formula() const;

 private:
  double b_;
};

/// The cells of every quantity between plates, whose velocity and temperature have the term x log x at
/// a plate.
inline const graded_plates plate_cells(0.05);

/// Returns the keys that the steady flows between plates share: rarefaction, model, 640 graded cells, and a
/// steady state without error in time. `parameters`: delta and model.
std::vector<std::string> between_plates(const std::map<std::string, std::string>& parameters);

}  // namespace apsis::validation
