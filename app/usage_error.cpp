#include "usage_error.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis::app {
namespace {

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// Returns the option that users of other programs mean by a word, or "" if this command lacks it.
std::string usual_option(const std::string& word, const std::vector<std::string>& names) {
  const bool output = word == "--output" || (word.rfind("-o", 0) == 0);
  const bool has_out = std::find(names.begin(), names.end(), "--out") != names.end();
  return output && has_out ? "--out" : "";
}

/// Returns the advice for an option that the command does not have.
std::string advice_on(const std::string& word, const CLI::App& command) {
  const std::vector<std::string> names = option_names(command);
  if (word == "--set" && command.get_option_no_throw("key=value") != nullptr)
    return "write key=value without --set";
  const std::string usual = usual_option(word, names);
  return usual.empty() ? suggest(word, names)
                       : fmt::format("did you mean '{}'? valid: {}", usual, fmt::join(names, ", "));
}

/// Returns the arguments that the command did not take, each once and without its value. Returns only
/// options if there are any: the words among the others may be their values.
std::vector<std::string> unexpected(const CLI::App& program) {
  std::vector<std::string> words, options;
  for (const std::string& argument : program.remaining(true)) {
    const bool option = argument.size() > 1 && argument.front() == '-';
    const std::string word = (option ? argument.substr(0, argument.find('=')) : argument).substr(0, 60);
    auto& list = option ? options : words;
    if (std::find(list.begin(), list.end(), word) == list.end()) list.push_back(word);
  }
  return options.empty() ? words : options;
}

[[noreturn]] void refuse_unexpected(const CLI::App& program, const CLI::App& command,
                                    const std::string& name) {
  const std::vector<std::string> all = unexpected(program);
  const bool options = all.front().size() > 1 && all.front().front() == '-';
  const std::string list = fmt::format("'{}'", fmt::join(all, "', '"));
  const char* plural = all.size() > 1 ? "s" : "";
  if (options)
    throw input_error(fmt::format("command line: unknown option{} {} ({} has no such option{}); {}", plural,
                                  list, name, plural, advice_on(all.front(), command)));
  throw input_error(fmt::format("command line: unexpected argument{} {} ({} takes fewer); see: {} --help",
                                plural, list, name, name));
}

/// Returns the first positional argument that is required and missing, or nullptr.
const CLI::Option* missing_argument(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional() && option->get_required() && option->count() == 0) return option;
  return nullptr;
}

}  // namespace

void check_first_argument(const std::string& first, const std::vector<std::string>& names) {
  if (first[0] == '-' || std::find(names.begin(), names.end(), first) != names.end()) return;
  std::string advice = suggest(first, names);
  if (first == "help" || first == "version") advice = fmt::format("write apsis --{}", first);
  throw input_error(fmt::format("command line: unknown command '{}' (apsis has no such command); {}",
                                first.substr(0, 60), advice));
}

void refuse_usage(const CLI::App& program, const CLI::ParseError& problem) {
  const auto chosen = program.get_subcommands();
  const CLI::App& command = chosen.empty() ? program : *chosen.front();
  const std::string name = chosen.empty() ? "apsis" : "apsis " + command.get_name();
  if (dynamic_cast<const CLI::ExtrasError*>(&problem) != nullptr && !unexpected(program).empty())
    refuse_unexpected(program, command, name);
  std::string message = problem.what();
  std::replace(message.begin(), message.end(), '\n', ' ');
  const CLI::Option* missing = missing_argument(command);
  const bool required = dynamic_cast<const CLI::RequiredError*>(&problem) != nullptr && missing != nullptr;
  throw input_error(
      fmt::format("command line: {} ({}); {}", message, name,
                  required ? fmt::format("give {}: {}", missing->get_name(), missing->get_description())
                           : fmt::format("see: {} --help", name)));
}

}  // namespace apsis::app
