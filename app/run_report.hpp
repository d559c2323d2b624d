#pragma once

#include <apsis/run/manifest.hpp>

#include <string>

namespace apsis::app {

/// Returns a summary of a run in some lines of text.
std::string summary_text(const simulation& run, run_end end, const run_records& records);

}  // namespace apsis::app
