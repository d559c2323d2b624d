#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace apsis {

/// Differences of a density of every cell between the last three steps. They alternate in unstable steps.
class step_differences {
 public:
  /// Sizes of the first and the second difference; 0 until enough steps are known.
  struct sizes {
    double change = 0.0,  ///< |ρ^n − ρ^{n−1}|
        turn = 0.0;       ///< |ρ^n − 2ρ^{n−1} + ρ^{n−2}|
  };

  /// Makes the differences for so many cells; no step is known yet.
  explicit step_differences(int cells) : last_(static_cast<std::size_t>(cells), unknown), before_(last_) {}

  /// Records the density of a cell after a step, once for each step. Different cells may be recorded
  /// simultaneously.
  sizes record(int cell, double density) {
    const auto k = static_cast<std::size_t>(cell);
    const double change = density - last_[k], turn = change - (last_[k] - before_[k]);
    before_[k] = last_[k];
    last_[k] = density;
    return {std::isnan(change) ? 0.0 : std::abs(change), std::isnan(turn) ? 0.0 : std::abs(turn)};
  }

  /// Forgets all steps.
  void restart() {
    last_.assign(last_.size(), unknown);
    before_ = last_;
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> last_, before_;
};

}  // namespace apsis
