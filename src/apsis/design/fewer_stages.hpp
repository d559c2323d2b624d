#pragma once

#include <apsis/design/search.hpp>

namespace apsis {

/// Removes a stage from a method that satisfies the demands of the task, if possible. Minimizes the weights
/// Σ_i (p_ik + w_ik) of a stage k in other stages subject to the equations. If they vanish, stage k is left
/// out. Stages are tried in ascending order of their weights. Returns nothing if local optimization removes
/// no stage. `report` is called with each stage and its residual weight, and `stop` ends the search when it
/// returns true.
std::optional<shu_osher_form<double>> without_a_stage(
    const design_task& task, const shu_osher_form<double>& m, const std::function<bool()>& stop = {},
    const std::function<void(std::size_t stage, double residual_weight)>& report = {});

}  // namespace apsis
