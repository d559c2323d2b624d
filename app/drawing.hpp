#pragma once

#include <string>
#include <vector>

namespace apsis::app {

/// Runs one of the Python scripts that are part of the program ("apsis_picture", "apsis_report") with these
/// arguments. Throws io_error if no Python with matplotlib is found
/// (the variable APSIS_PYTHON names one) or the script fails.
void draw(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace apsis::app
