#pragma once

#include <apsis/config/case.hpp>
#include <apsis/model/model.hpp>

#include <string>

namespace apsis {

/// Returns why the velocities of a gas do not hold the Maxwellian that a face emits between t = 0 and
/// time.end, with the face and the time; "" if they hold all of them. Formulas are sampled at 201 times.
std::string unsupported_boundary(const case_config& config, const model& equation);

}  // namespace apsis
