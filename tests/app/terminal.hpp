#pragma once

#include "program.hpp"

namespace app_test {

/// Runs the program with standard error on a terminal of so many columns (0: of unknown width), and standard
/// output in a file, as in `apsis … > file`. `err` is what the terminal received.
outcome run_on_terminal(const work_folder& folder, const std::vector<std::string>& arguments,
                        unsigned short columns);

}  // namespace app_test
