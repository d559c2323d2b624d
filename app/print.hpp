#pragma once

#include <string>

namespace apsis::app {

/// Writes results to standard output. Throws io_error if that fails.
void print(const std::string& text);

}  // namespace apsis::app
