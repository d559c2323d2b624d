#pragma once

#include <apsis/run/manifest.hpp>

#include <string>

namespace apsis::app {

/// A few lines for a person.
std::string summary_text(const simulation& run, run_end end);

}  // namespace apsis::app
