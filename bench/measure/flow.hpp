#pragma once

#include <apsis/config/case.hpp>
#include <apsis/run/simulation.hpp>

#include <string>

namespace apsis::bench {

/// Returns a built-in case without an early end or output. Its cells are divided until a state has at least
/// `numbers` numbers; 0 leaves the cells of the shipped case.
case_config flow_of_size(const std::string& name, double numbers);

/// Returns the number of unknowns in the cells with gas. Cells that share their unknowns count once.
double gas_unknowns(const simulation& of);

/// Returns how many of the gas_unknowns are in cells that bodies cut.
double cut_unknowns(const simulation& of);

/// Returns the gas_unknowns times the stages of a step.
double point_stages(const simulation& of);

void advance(simulation& run, int steps);

/// Returns the number of steps that take about a tenth of a second; a thousandth for a quick measurement.
int steps_to_measure(simulation& run, bool quick);

}  // namespace apsis::bench
