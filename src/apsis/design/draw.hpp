#pragma once

#include <apsis/core/random_source.hpp>
#include <apsis/design/search.hpp>

namespace apsis {

/// Returns the pattern of the given method with all weights P and W free. Its zeros in d and ḋ are kept where
/// they may be required (intermediate regime, order 5 without transport).
zero_pattern pattern_near(const design_task& task, const shu_osher_form<double>& m);

/// Draws the pattern of a start. It has all coefficients that the task allows. Choices on which the equations
/// depend are random: stages whose T is evaluated, stages with ḋ = 0 for the intermediate regime, and stages
/// with d = 0 for order 5 without transport. The pattern stays close to `task.from`, if given. If `task.from`
/// has fewer evaluations of T than the task, each start frees T at other additional stages.
zero_pattern draw_pattern(const design_task& task, random_source& random);

/// Draws the initial coefficients of a start: within the bounds, and in general far from satisfying the
/// equations. The first start from a given method is that method.
Eigen::VectorXd draw_coefficients(const design_task& task, const design_problem& problem,
                                  random_source& random, bool is_first);

}  // namespace apsis
