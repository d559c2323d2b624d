#pragma once

#include <apsis/model/model.hpp>
#include <apsis/phase/field.hpp>
#include <apsis/run/simulation.hpp>

#include <vector>

namespace apsis {

/// Checks the state after every step: smallest value, conservation, entropy. Sums have a fixed order, so that
/// results do not depend on the number of threads.
class monitor {
 public:
  /// `volume` is the cell volume (1 for an ordinary differential equation).
  monitor(const model& equation, double volume) : equation_(equation), volume_(volume) {}

  /// Sets the reference state of conservation and returns its record: defects are |I − I₀| relative to
  /// Σ_cells volume · model::invariant_scales().
  step_record start(const field& u);

  /// Returns the record of a state without step, t and dt. Throws numerical_error at the first number that is
  /// not finite.
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
