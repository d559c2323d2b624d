#include "method_writer.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/method/export.hpp>
#include <apsis/method/method_text.hpp>

#include <fmt/format.h>

namespace apsis::app {

namespace {

/// Returns the folder of a method file to be written. It is not created, because a mistyped path would leave
/// folders behind.
std::filesystem::path folder_of(const std::filesystem::path& path) {
  if (!path.has_filename() || path.extension() != ".toml")
    throw input_error(fmt::format(
        "command line: --out '{}' is not a method file (it does not end in .toml); give FILE.toml",
        path.string()));
  const std::string name = path.stem().string();
  if (const auto problem = method_name_problem(name); !problem.empty())
    throw input_error(
        fmt::format("command line: --out '{}' would name the method '{}': {}", path.string(), name, problem));
  if (is_method_name(name))
    throw input_error(fmt::format(
        "command line: --out '{}' would name the method '{}' (the catalogue has one of this name, or a "
        "family reserves it); choose another file name",
        path.string(), name));
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    throw input_error(
        fmt::format("command line: no folder '{}' for --out '{}' (it is not created automatically); create "
                    "it first or correct the path",
                    folder.string(), path.string()));
  return folder;
}

}  // namespace

method_writer::method_writer(const std::string& path) : path_(path), folder_(folder_of(path_)) {}

void method_writer::write(const method& m) {
  folder_.publish_text(path_.filename().string(), to_toml(m));
}

}  // namespace apsis::app
