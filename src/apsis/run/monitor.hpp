#pragma once

#include <apsis/model/model.hpp>
#include <apsis/phase/field.hpp>
#include <apsis/run/simulation.hpp>

#include <vector>

namespace apsis {

/// Looks at the state after every step: smallest value, conservation, entropy. Sums run in a fixed order, so
/// the numbers do not depend on threads.
class monitor {
 public:
  /// `volume` is that of a cell (1 for an ordinary differential equation).
  monitor(const model& equation, double volume) : equation_(equation), volume_(volume) {}

  /// The state against which conservation is measured: defects are |I − I₀| over Σ_cells volume ·
  /// model::invariant_scales().
  step_record start(const field& u);

  /// Everything but step, t and dt. Throws numerical_error at the first number that is not finite.
  step_record check(const field& u, double previous_entropy) const;

 private:
  struct totals {
    std::vector<double> invariants, scales;
    double entropy, lowest;
    long negative;
  };
  totals sum(const field& u) const;

  const model& equation_;
  double volume_;
  std::vector<double> invariants_, scales_;
};

}  // namespace apsis
