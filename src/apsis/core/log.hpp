#pragma once

#include <string>

/// Messages for a person, on standard error; standard output belongs to results.
namespace apsis::log {

/// Which messages are shown.
enum class level {
  quiet,    ///< none
  warning,  ///< warnings
  info      ///< all
};

/// For the whole process; level::info at the beginning.
void set_level(level lowest);
/// What the program does or has left behind.
void info(const std::string& message);
/// What the user may not have meant; the program goes on.
void warning(const std::string& message);

}  // namespace apsis::log
