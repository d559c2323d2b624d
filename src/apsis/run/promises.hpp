#pragma once

#include <apsis/run/rounding.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

namespace apsis {

/// Whether collisions conserve to rounding: E(ω) has the moments ω. A Maxwellian by formula may not; then a
/// warning gives the defect measured on the initial state, relative to the scales of the invariants.
bool conserves_to_rounding(const run_setup& setup, const field& initial, const rounding_bound& rounding);

/// Throws numerical_error with step, time and value where the record of a step breaks a promise, and says why
/// that may be and what helps. `before` is the record of the step before: an invariant may change no more in
/// one step than one step rounds, however long the run.
void check_promises(const run_promises& promises, const step_record& before, const step_record& last,
                    const run_setup& setup, const rounding_bound& rounding);

}  // namespace apsis
