#pragma once

#include <apsis/core/random_source.hpp>
#include <apsis/method/tableau.hpp>

namespace apsis {

/// Returns the method with stages inserted at random places until it has `stages` of them. A new stage
/// relaxes the stage before it (p = 1, random d, with or without ḋ). It has no weight in later stages, so
/// that the result of a step is the same. A search that may change these weights starts from a solution of
/// its equations. The first `given` rows keep their places.
shu_osher_form<double> with_more_stages(shu_osher_form<double> m, std::size_t stages, random_source& random,
                                        std::size_t given = 1);

/// Returns the two-step form (method/kinds/two_step.hpp) of a method of one step: a first row for u^{n−1},
/// which has no weight.
shu_osher_form<double> with_previous_value(const shu_osher_form<double>& m);

}  // namespace apsis
