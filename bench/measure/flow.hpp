#pragma once

#include <apsis/config/case.hpp>
#include <apsis/run/simulation.hpp>

#include <string>

namespace apsis::bench {

/// Returns a built-in case without an early end or output, with cells divided so often that a state has this
/// many numbers; as it is shipped for 0.
case_config flow_of_size(const std::string& name, double numbers);

/// Returns the numbers of unknowns in the cells with gas. Cells with one unknown in common count once.
double gas_unknowns(const simulation& of);

/// Returns the unknowns in cells that bodies cut, among the gas_unknowns.
double cut_unknowns(const simulation& of);

/// Returns the gas_unknowns of a step, at every stage.
double point_stages(const simulation& of);

void advance(simulation& run, int steps);

/// Returns the number of steps that take about a tenth of a second; a thousandth for a quick measurement.
int steps_to_measure(simulation& run, bool quick);

}  // namespace apsis::bench
