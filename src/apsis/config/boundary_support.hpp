#pragma once

#include <apsis/config/case.hpp>
#include <apsis/model/model.hpp>
#include <apsis/model/velocity_support.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Returns the words for messages about the velocities of a case.
velocity_words words_of(const case_config& config, const std::string& subject);

/// Checks the Maxwellians that walls, open ends and the source of a case emit between t = 0 and time.end. The
/// velocities of the gas must represent them, by the rule of velocity_support.hpp. Formulas are sampled.
/// Throws input_error at the table that emits a Maxwellian beyond velocity_limits::bad. Returns a warning for
/// each beyond velocity_limits::good.
std::vector<std::string> check_emitted_gas(const case_config& config, const model& equation);

}  // namespace apsis
