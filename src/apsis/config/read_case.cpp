// Finds the text of a case by its name or path.
#include <apsis/config/case.hpp>
#include <apsis/config/case_text.hpp>
#include <apsis/core/embedded.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/core/text_file.hpp>

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

namespace apsis {
namespace {

namespace fs = std::filesystem;

/// Returns "cylinder" for "gas/cylinder" and for "cases/gas/cylinder.toml".
std::string last_part(const std::string& name_or_path) {
  const fs::path path(name_or_path);
  return (path.extension() == ".toml" ? path.stem() : path.filename()).string();
}

/// Returns the built-in case with a similar name or last part, or "".
std::string nearest_case(const std::string& word) {
  const std::vector<std::string> names = case_names();
  if (std::string whole = nearest_word(word, names); !whole.empty()) return whole;
  std::vector<std::string> parts;
  for (const auto& name : names) parts.push_back(last_part(name));
  const auto found = std::find(parts.begin(), parts.end(), nearest_word(last_part(word), parts));
  return found == parts.end() ? "" : names[static_cast<std::size_t>(found - parts.begin())];
}

void refuse_other_than_case(const std::string& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) {
    const std::string nearest = nearest_case(path);
    throw input_error(
        fmt::format("no case '{}' (no file and no built-in case has this name); {}see: {}", shown(path),
                    nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest), "apsis list cases"));
  }
  if (fs::path(path).extension() == ".h5")
    throw input_error(
        fmt::format("'{}' is not a case file (it has the name of an HDF5 file); to continue a run give its "
                    "case, and --restart {}",
                    shown(path), shown(path)));
  if (!fs::is_directory(path, ignored)) return;
  if (fs::exists(fs::path(path) / "manifest.json", ignored))
    throw input_error(
        fmt::format("'{}' is not a case file (it is a folder of results); give a case file, or draw the "
                    "results: apsis plot {}",
                    shown(path), shown(path)));
  throw input_error(fmt::format("'{}' is not a case file (it is a folder); give a file", shown(path)));
}

}  // namespace

std::string read_case(const std::string& name_or_path) {
  for (const auto& built_in : embedded::cases())
    if (built_in.name == name_or_path) return std::string(built_in.text);
  refuse_other_than_case(name_or_path);
  return read_text_file(name_or_path, longest_case_file, "case file");
}

std::vector<std::string> case_names() {
  std::vector<std::string> names;
  for (const auto& built_in : embedded::cases()) names.emplace_back(built_in.name);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace apsis
