#pragma once

#include <apsis/design/nonlinear_program.hpp>
#include <apsis/design/search.hpp>

namespace apsis {

/// Returns the method at x as a candidate without coefficients below `zero`: these are removed from the
/// pattern and the equations solved again, starting from x. If that fails, returns the solution close to x
/// with the original pattern.
design_candidate drop_zeros(design_problem& problem, const Eigen::VectorXd& x, double zero = 1e-6);

/// Removes coefficients one by one, smallest first, and reoptimizes, as long as the objective worsens by no
/// more than `tolerance` (relative) in total. Fewer coefficients mean less work and fewer buffers.
design_candidate sparsify(const design_task& task, design_candidate candidate, double tolerance,
                          const std::function<bool()>& stop = {});

}  // namespace apsis
