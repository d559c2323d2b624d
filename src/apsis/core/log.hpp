#pragma once

#include <string>

/// Messages to the user on standard error; standard output is reserved for results.
namespace apsis::log {

/// Verbosity.
enum class level {
  quiet,    ///< no messages
  warning,  ///< warnings only
  info      ///< all messages
};

/// Sets the verbosity of the process, initially level::info, and returns the previous one.
level set_level(level lowest);
/// Receives the message of a warning. Several threads may call it simultaneously.
using warning_receiver = void (*)(const std::string& message);

/// Sends warnings to a function instead of standard error, unless level::quiet hides them. Returns the
/// previous function; nullptr stands for standard error.
warning_receiver set_warning_receiver(warning_receiver receiver);
/// Reports what the program does or has written. Shown at level::info.
void info(const std::string& message);
/// Reports a likely mistake; the program continues. A live warnings_once hides repeated messages. Every live
/// warning_record stores the others.
void warning(const std::string& message);

}  // namespace apsis::log
