#pragma once

#include <apsis/run/manifest.hpp>

#include <string>

namespace apsis::app {

/// Summary of a run in a few lines of text.
std::string summary_text(const simulation& run, run_end end, const run_records& records);

}  // namespace apsis::app
