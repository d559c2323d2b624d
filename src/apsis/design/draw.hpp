#pragma once

#include <apsis/core/random_source.hpp>
#include <apsis/design/search.hpp>

namespace apsis {

/// What a given method has, and every weight besides. Where its d or ḋ is zero, it stays so if that may have
/// a reason (the intermediate regime, order 5 without transport).
zero_pattern pattern_near(const design_task& task, const shu_osher_form<double>& m);

/// Which coefficients a start leaves free: all that the task allows, and what must be chosen because the
/// equations depend on it (stages whose T is evaluated; stages with ḋ = 0 for the intermediate regime; stages
/// with d = 0 for order 5 without transport). Near `task.from` if there is one; if it has fewer evaluations
/// of T than the task, T is free at further stages, others for each start.
zero_pattern draw_pattern(const design_task& task, random_source& random);

/// Where a start begins: coefficients within the bounds, in general far from satisfying the equations. The
/// first start from a given method is that method.
Eigen::VectorXd draw_coefficients(const design_task& task, const design_problem& problem,
                                  random_source& random, bool is_first);

}  // namespace apsis
