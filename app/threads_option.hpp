#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

namespace apsis::app {

/// Adds --threads with its range. `what` begins the help ("threads to use"); `otherwise` describes the
/// default when neither the option nor OMP_NUM_THREADS is set.
void add_threads(CLI::App& command, std::optional<int>& threads, const std::string& what,
                 const std::string& otherwise);

}  // namespace apsis::app
