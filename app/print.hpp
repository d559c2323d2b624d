#pragma once

#include <string>

namespace apsis::app {

/// Writes results to standard output. printable() escapes control characters; in JSON and TOML the escapes
/// stand for the same characters. Throws io_error if that fails.
void print(const std::string& text);

}  // namespace apsis::app
