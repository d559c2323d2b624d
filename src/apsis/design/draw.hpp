#pragma once

#include <apsis/core/random_source.hpp>
#include <apsis/design/search.hpp>

namespace apsis {

/// Which coefficients a start leaves free: all that the task allows, and what must be chosen because the
/// equations depend on it (stages whose T is evaluated; stages with ḋ = 0 for the intermediate regime; stages
/// with d = 0 for order 5 without transport). Near `task.from` if there is one.
zero_pattern draw_pattern(const design_task& task, random_source& random);

/// Where a start begins: coefficients within the bounds, in general far from satisfying the equations. The
/// first start from a given method is that method.
Eigen::VectorXd draw_coefficients(const design_task& task, const design_problem& problem,
                                  random_source& random, bool is_first);

}  // namespace apsis
