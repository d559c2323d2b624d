#include "file_kind.hpp"

#include <apsis/config/case_text.hpp>
#include <apsis/core/text_file.hpp>

#include <algorithm>
#include <array>
#include <sstream>

namespace apsis::app {

int line_of_model(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    if (line.rfind("[model]", 0) == 0) return number;
  return 0;
}

bool is_case_file(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) &&
         line_of_model(read_text_file(path, longest_case_file, "file")) > 0;
}

bool has_results(const std::filesystem::path& folder) {
  constexpr std::array<const char*, 4> names = {"manifest.json", "picture.json", "reproduce.json",
                                                "validate.json"};
  return std::any_of(names.begin(), names.end(), [&folder](const char* name) {
    std::error_code ignored;
    return std::filesystem::exists(folder / name, ignored);
  });
}

}  // namespace apsis::app
