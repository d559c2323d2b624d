#pragma once

#include <apsis/run/simulation.hpp>

#include <string>

namespace apsis::app {

/// Returns "  drag 0.0452 (top)  heat 0.0054 (right)": the largest shear force on a gas and the largest heat
/// flux into it through a surface, in the last step. Returns "" for other models. Dimensionless.
std::string loads_text(const simulation& now);

}  // namespace apsis::app
