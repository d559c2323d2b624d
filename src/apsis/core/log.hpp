#pragma once

#include <string>

/// Messages for a person, on standard error; standard output belongs to results.
namespace apsis::log {

enum class level { quiet, warning, info };

void set_level(level lowest);
void info(const std::string& message);
void warning(const std::string& message);

}  // namespace apsis::log
