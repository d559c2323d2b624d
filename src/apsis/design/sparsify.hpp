#pragma once

#include <apsis/design/nonlinear_program.hpp>
#include <apsis/design/search.hpp>

namespace apsis {

/// The method at x as a candidate whose pattern has no coefficient below `zero`: these are left out and the
/// equations solved again for the others, nearest to x. If they then cannot be solved, the solution nearest
/// to x with the pattern as it is.
design_candidate drop_zeros(design_problem& problem, const Eigen::VectorXd& x, double zero = 1e-6);

/// Leaves out one coefficient after the other, the smallest first, optimising again, as long as the objective
/// worsens by no more than `tolerance` (relative) in all. Fewer coefficients are less work and fewer buffers.
design_candidate sparsify(const design_task& task, design_candidate candidate, double tolerance,
                          const std::function<bool()>& stop = {});

}  // namespace apsis
