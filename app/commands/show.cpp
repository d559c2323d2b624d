#include "command_registry.hpp"
#include "file_kind.hpp"
#include "method_document.hpp"
#include "print.hpp"

#include <apsis/body/read_stl.hpp>
#include <apsis/config/case.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/embedded.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/method_file.hpp>
#include <apsis/method/time_integrator.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

namespace apsis::app {
namespace show_command {
namespace {

struct options {
  std::string what, format;
};

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void only_text(const options& given) {
  if (!given.format.empty() && given.format != "text")
    throw input_error(fmt::format("command line: --format {} is for methods ('{}' is a text); leave it out",
                                  given.format, given.what));
}

/// Prints the file of a method of several steps, whose tables have another form than those of one step.
void show_several_steps(const options& given) {
  const time_integrator& m = find_integrator(given.what);
  if (m.file() == nullptr)
    throw input_error(
        fmt::format("method '{}' has no file (its coefficients are those of a formula); see: "
                    "apsis check {}",
                    given.what, given.what));
  if (!given.format.empty() && given.format != "toml")
    throw input_error(fmt::format(
        "command line: --format {} is for methods of one step ('{}' takes two); use --format toml",
        given.format, given.what));
  for (const auto& file : embedded::methods())
    if (file.name == given.what) print(std::string(file.text));
}

int show(const options& given) {
  const std::vector<std::string> cases = case_names();
  if (given.what == "case") {
    only_text(given);
    print(schema_text());
  } else if (contains(cases, given.what)) {
    only_text(given);
    for (const auto& built_in : embedded::cases())
      if (built_in.name == given.what) print(std::string(built_in.text));
  } else if (const auto surface = built_in_stl(given.what)) {
    only_text(given);
    print(*surface);
  } else if (is_method_name(given.what)) {
    print(method_document(find_method(given.what), given.format.empty() ? "text" : given.format));
  } else if (contains(names_of_several_steps(), given.what)) {
    show_several_steps(given);
  } else if (is_case_file(given.what)) {
    only_text(given);
    print(read_case(given.what));
  } else if (std::filesystem::is_regular_file(given.what)) {
    print(method_document(load_method_file(given.what), given.format.empty() ? "text" : given.format));
  } else {
    std::vector<std::string> all;
    for (const auto& file : embedded::methods()) all.emplace_back(file.name);
    all.insert(all.end(), cases.begin(), cases.end());
    for (const auto& file : embedded::surfaces()) all.push_back(fmt::format("{}.stl", file.name));
    all.emplace_back("case");
    throw input_error(
        fmt::format("nothing is called '{}' (no method, case, STL file or file has this name); {}",
                    given.what.substr(0, 60),
                    suggest_from_list(given.what, all, "apsis list methods, apsis list cases")));
  }
  return 0;
}

action define(CLI::App& command) {
  auto given = std::make_shared<options>();
  command
      .add_option("WHAT", given->what, "a method or a case, by name or file, a built-in STL file, or: case")
      ->required();
  command.add_option("--format", given->format, "format for a method: text, json, latex or toml")
      ->check(CLI::IsMember({"text", "json", "latex", "toml"}));
  return [given] { return show(*given); };
}

}  // namespace
}  // namespace show_command

extern const command_entry command_show;
const command_entry command_show = {
    .name = "show",
    .summary = "Show a method, a built-in case or its STL file, or the keys of a case (show case)",
    .place = 40,
    .completion = completed_from_list("methods"),
    .define = show_command::define};

}  // namespace apsis::app
