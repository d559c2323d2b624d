#pragma once

#include <apsis/model/model.hpp>
#include <apsis/phase/field.hpp>
#include <apsis/run/simulation.hpp>

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace apsis {

/// Checks the state after every step: smallest value, conservation, entropy. Sums have a fixed order, so that
/// results do not depend on the number of threads.
class monitor {
 public:
  /// `volume` is the cell volume (1 for an ordinary differential equation), `ends` as run_setup::open_ends(),
  /// and `cells` those of the gas, all if there are none. `entropy_bounds` as those of run_setup; empty if
  /// there are none.
  monitor(const model& equation, double volume, std::vector<std::size_t> ends,
          std::vector<double> entropy_bounds = {}, std::vector<cell_range> cells = {})
      : equation_(equation),
        volume_(volume),
        ends_(std::move(ends)),
        entropy_bounds_(std::move(entropy_bounds)),
        cells_(std::move(cells)) {}

  /// Sets the reference state of conservation and returns its record: defects are relative to Σ_cells volume
  /// · model::invariant_scales().
  step_record start(const field& u);

  /// Returns the number of gains of a step at all ends, force and source.
  std::size_t size_of_gains() const;

  /// Returns the record of the state after a step of length dt, whose gains through the faces are those of
  /// the step; without step and t. Throws numerical_error at the first number that is not finite.
  step_record check(const field& u, double dt, const step_record& previous) const;

 private:
  struct totals {
    std::vector<double> invariants, scales;
    double entropy, lowest;
    long negative;
    long violating;  ///< first cell that violates the condition of the model; −1 if there is none
  };
  std::optional<condition_violation> violation_in(const field& u, const totals& t) const;
  totals sum(const field& u) const;
  std::vector<double> gained_through_faces(const std::vector<double>& gains) const;
  void compare(const totals& t, const std::vector<double>& before, const std::vector<double>& gained,
               step_record& record) const;

  const model& equation_;
  double volume_;
  std::vector<std::size_t> ends_;       ///< number at each face
  std::vector<double> entropy_bounds_;  ///< of what is received, [face][invariant]
  std::vector<cell_range> cells_;
  std::vector<double> invariants_, scales_;  ///< of the initial state
};

}  // namespace apsis
