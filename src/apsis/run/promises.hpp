#pragma once

#include <apsis/run/rounding.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

namespace apsis {

/// Returns whether collisions conserve to rounding, that is, whether E(ω) has the moments ω. Otherwise warns,
/// with the defect of the initial state relative to the scales of the invariants.
bool conserves_to_rounding(const run_setup& setup, const field& initial, const rounding_bound& rounding);

/// Relative change of the relaxation of model::cut_moment() beyond which a run warns.
inline constexpr double harmless_cut = 1e-3;
/// Warns when the cut of a step exceeds harmless_cut for the first time. `largest` is the largest cut
/// of all earlier steps.
void warn_of_cut(const run_setup& setup, double largest, double cut);

/// Throws numerical_error with step, time, value, possible cause and remedy if the record of a step breaks a
/// promise. In each step an invariant may change by the amounts that cross the faces and by the rounding of
/// one step. This bound does not depend on the length of the run.
void check_promises(const run_promises& promises, const step_record& last, const run_setup& setup,
                    const rounding_bound& rounding);

}  // namespace apsis
