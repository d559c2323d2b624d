#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace apsis::app {

/// Action of a command, run when the whole command line is valid; returns the exit code.
using action = std::function<int()>;

/// One command of the program: a file of app/commands/ defines `extern const command_entry command_<file>`.
struct command_entry {
  std::string name;     ///< the word after `apsis`
  std::string summary;  ///< one line, for the help and the manual page
  int place = 1000;     ///< position in the help, lowest first; by name among equals
  /// Words that complete an argument, as bash expands them in double quotes; "": file names only.
  std::string completion{};
  bool shares_work = false;  ///< whether several processes that mpirun starts share the work
  /// Adds options and arguments, and returns the action of the command.
  action (*define)(CLI::App& command) = nullptr;
};

/// Returns every command, sorted by file name (generated).
std::vector<const command_entry*> command_entries();

/// Returns every command in the order of the help.
std::vector<const command_entry*> commands_in_order();

/// Returns the completion of arguments that are names listed by `apsis list WHAT`.
std::string completed_from_list(const std::string& what);

}  // namespace apsis::app
