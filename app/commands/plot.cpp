#include "command_registry.hpp"
#include "drawing.hpp"
#include "file_kind.hpp"
#include "interrupt.hpp"
#include "method_document.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/method/method.hpp>

#include <filesystem>
#include <memory>

#include <fmt/format.h>

namespace apsis::app {
namespace plot_command {
namespace {

namespace fs = std::filesystem;

struct options {
  std::vector<std::string> what;
  std::string out, format = "png", compare, slice;
  bool frames = false;
};

/// Writes a method to a file from which its pictures are drawn; returns the path.
std::string described(const drawing& pictures, std::size_t place, const method& m) {
  return pictures.add(fmt::format("method-{}.json", place), method_document(m, "json"));
}

/// Refuses what is neither a result nor a method, before Python starts.
void check_what(const std::string& what) {
  const fs::path path(what);
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    if (has_results(path)) return;
    throw input_error(fmt::format(
        "cannot draw '{:.200}' (not a folder of results); give the folder of apsis run --out", what));
  }
  if (path.extension() == ".json" || is_method_name(what)) return;
  if (!fs::is_regular_file(path, ignored))
    throw input_error(fmt::format("cannot draw '{}' (no folder, file or method of this name); {}",
                                  what.substr(0, 60),
                                  suggest_from_list(what, method_names(), "apsis list methods")));
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (path.extension() != ".toml" && has_results(folder))
    throw input_error(
        fmt::format("cannot draw '{:.200}' (it is one file of a folder of results); give the folder {}", what,
                    folder.string()));
  if (is_case_file(what))
    throw input_error(
        fmt::format("cannot draw '{:.200}' (it is a case); apsis run {:.200} --out DIR, then apsis plot DIR",
                    what, what));
}

/// Returns the names of the folders of results beside a path, as the path would name them.
std::vector<std::string> results_beside(const fs::path& path) {
  constexpr std::size_t most = 1000;
  const fs::path parent = path.parent_path();
  std::vector<std::string> names;
  std::error_code problem;
  for (fs::directory_iterator entry(parent.empty() ? fs::path(".") : parent, problem), end;
       !problem && entry != end && names.size() < most; entry.increment(problem))
    if (entry->is_directory(problem) && has_results(entry->path()))
      names.push_back((parent / entry->path().filename()).string());
  return names;
}

/// Refuses LABEL=DIR or DIR without a run in the folder, before Python starts.
void check_compared(const std::string& what) {
  const auto label = what.rfind('=');
  const std::string name = label == std::string::npos ? what : what.substr(label + 1);
  std::error_code ignored;
  const bool exists = fs::exists(name, ignored);
  if (fs::is_directory(name, ignored) && has_results(name)) return;
  const std::string near = exists ? "" : nearest_word(name, results_beside(name));
  throw input_error(fmt::format(
      "cannot compare '{:.200}' ({}); {}", name,
      exists ? "not a folder of results" : "no folder of this name",
      near.empty() ? "give the folders of apsis run --out" : fmt::format("did you mean '{}'?", near)));
}

int plot(const options& given) {
  watch_for_interrupts("the end of the drawing");
  for (const auto& what : given.what)
    if (given.compare.empty())
      check_what(what);
    else
      check_compared(what);
  const drawing pictures;
  std::vector<std::string> arguments;
  for (std::size_t k = 0; k < given.what.size(); ++k) {
    const std::string& what = given.what[k];
    if (!given.compare.empty() || fs::is_directory(what) || fs::path(what).extension() == ".json")
      arguments.push_back(what);
    else if (fs::is_regular_file(what))
      arguments.push_back(described(pictures, k, load_method_file(what)));
    else
      arguments.push_back(described(pictures, k, find_method(what)));
  }
  arguments.insert(arguments.end(), {"--format", given.format});
  if (!given.out.empty()) arguments.insert(arguments.end(), {"--out", given.out});
  if (!given.slice.empty()) arguments.insert(arguments.end(), {"--slice", given.slice});
  if (given.frames) arguments.emplace_back("--frames");
  if (!given.compare.empty()) arguments.insert(arguments.end(), {"--compare", given.compare});
  const int status = pictures.run("plot", arguments, false);
  if (status < 0) throw io_error("drawing failed (Python ended without a status); try again");
  return status;
}

action define(CLI::App& command) {
  auto given = std::make_shared<options>();
  command
      .add_option("WHAT", given->what,
                  "folders of results (pictures go into DIR/pictures), picture.json files, methods or method "
                  "files; with --compare folders of runs, also as LABEL=DIR")
      ->required();
  command.add_option("--out", given->out, "folder for the pictures");
  command.add_option("--format", given->format, "file format: png, svg or pdf")
      ->check(CLI::IsMember({"png", "svg", "pdf"}))
      ->capture_default_str();
  command.add_option("--compare", given->compare,
                     "draw these runs of one model into one picture of this name, and print their distance "
                     "from the one with most cells");
  command.add_option(
      "--slice", given->slice,
      "of a result in space: the plane AXIS=PLACE, z=0.5, in place of those in the middle or of symmetry");
  command.add_flag("--frames", given->frames,
                   "also every snapshot as frame-NUMBER, with one range of colours, for an animation");
  return [given] { return plot(*given); };
}

}  // namespace
}  // namespace plot_command

extern const command_entry command_plot;
const command_entry command_plot = {
    .name = "plot",
    .summary = "Draw results of any kind, or the stability regions of a method",
    .place = 80,
    .completion = completed_from_list("methods"),
    .define = plot_command::define};

}  // namespace apsis::app
