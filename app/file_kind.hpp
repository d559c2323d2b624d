#pragma once

#include <filesystem>
#include <string>

namespace apsis::app {

/// Returns the line of the table [model] in a text, which makes it a case; 0 if it has none.
int line_of_model(const std::string& text);

/// Whether the file is readable and a case.
bool is_case_file(const std::string& path);

/// Whether the folder has results that can be drawn: those of a run or a study.
bool has_results(const std::filesystem::path& folder);

}  // namespace apsis::app
