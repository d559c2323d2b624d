#pragma once

#include "stiff_task.hpp"

namespace apsis::bench::peers {

struct radau_options {
  double rtol = 1e-6, atol = 1e-8;
};

/// Runs the Radau IIA method of order 5 with the error estimate, the simplified Newton iteration, its
/// starting values and the predictive step control of RADAU5 (Hairer, Wanner, Solving Ordinary Differential
/// Equations II, section IV.8). Its three stages are one dense system of six unknowns, without the
/// transformation that pays for larger systems.
outcome run_radau(const stiff_task& task, const radau_options& options);

}  // namespace apsis::bench::peers
