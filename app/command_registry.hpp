#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace apsis::app {

/// What a command does once the whole command line is known to be good; returns the exit code.
using action = std::function<int()>;

/// One command of the program: a file of app/commands/ defines `extern const command_entry command_<file>`.
struct command_entry {
  std::string name;     ///< the word behind `apsis`
  std::string summary;  ///< one line, for the help and the manual page
  int place = 1000;     ///< in the help, lowest first; by name among equals
  /// Words that complete an argument, as bash expands them in double quotes; "": file names only.
  std::string completion = "";
  /// Adds options and arguments, and returns what runs when the command is chosen.
  action (*define)(CLI::App& command) = nullptr;
};

/// Every command, sorted by file name (generated).
std::vector<const command_entry*> command_entries();

/// Every command in the order of the help.
std::vector<const command_entry*> commands_in_order();

/// The completion of arguments that are names of `apsis list WHAT`.
std::string completed_from_list(const std::string& what);

}  // namespace apsis::app
