#pragma once

#include <string>

namespace apsis::app {

/// Writes results to standard output. Throws io_error if they did not arrive.
void print(const std::string& text);

}  // namespace apsis::app
