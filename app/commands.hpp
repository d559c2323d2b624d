#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace apsis::app {

/// What the command line asked for; returns the exit code. Commands only note it while the line is parsed, so
/// that nothing runs before the whole line is known to be good.
using action = std::function<int()>;

/// Each adds one command to the program.
void add_run(CLI::App& program, action& chosen);
void add_converge(CLI::App& program, action& chosen);
void add_list(CLI::App& program, action& chosen);
void add_show(CLI::App& program, action& chosen);
void add_check(CLI::App& program, action& chosen);
void add_design(CLI::App& program, action& chosen);
void add_plot(CLI::App& program, action& chosen);
void add_report(CLI::App& program, action& chosen);
void add_info(CLI::App& program, action& chosen);
void add_reproduce(CLI::App& program, action& chosen);
void add_manual(CLI::App& program, action& chosen);

/// What `apsis list` can list.
std::vector<std::string> list_names();

/// Writes results to standard output. Throws io_error if they did not arrive.
void print(const std::string& text);

}  // namespace apsis::app
