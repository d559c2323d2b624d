#pragma once

#include <apsis/design/search.hpp>

namespace apsis {

/// A method with one stage fewer, from one that satisfies the demands of the task: of a stage k the weights
/// that others give it, Σ_i (p_ik + w_ik), are made as small as the equations allow; where that is zero, the
/// stage can be left out. Stages are tried in the order of their weights. Nothing if all are needed, as far
/// as local solutions tell. `report` is told each stage and what is left of its weights.
std::optional<shu_osher_form<double>> without_a_stage(
    const design_task& task, const shu_osher_form<double>& m, const std::function<bool()>& stop = {},
    const std::function<void(std::size_t stage, double left)>& report = {});

}  // namespace apsis
