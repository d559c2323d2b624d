#pragma once

#include "program.hpp"

namespace app_test {

/// Runs the program with standard error on a terminal of the given number of columns (0: unknown width).
/// Standard output is a file, as in `apsis … > file`. `err` is the text that the terminal received.
outcome run_on_terminal(const work_folder& folder, const std::vector<std::string>& arguments,
                        unsigned short columns);

}  // namespace app_test
