#pragma once

#include <apsis/run/simulation.hpp>

#include <string>

namespace apsis::app {

/// Returns "  drag 0.0452 (top)  heat 0.0054 (right)": the largest shear force and the largest heat that a
/// surface gives to a gas in the last step, per unit of time; "" for other models. Dimensionless.
std::string loads_text(const simulation& now);

}  // namespace apsis::app
