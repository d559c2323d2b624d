#pragma once

#include <apsis/method/method.hpp>

#include <string>

namespace apsis::app {

/// Returns the coefficients and claims of a method; `format` is "text", "json", "latex" or "toml".
std::string method_document(const method& m, const std::string& format);

}  // namespace apsis::app
