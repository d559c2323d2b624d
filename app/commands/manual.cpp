#include "command_registry.hpp"
#include "print.hpp"

#include <apsis/core/version.hpp>

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace manual_command {
namespace {

/// Escapes a text for a manual page, where backslashes, hyphens, and dots or quotes at the beginning of a
/// line have a special meaning.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
      out += c;
    }
  }
  return out;
}

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App* command) { return !command->get_name().empty(); });
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option*) { return true; });
}

/// Returns the usage of an option, such as "--out TEXT" or "CASE".
std::string usage_of(const CLI::Option& option) {
  if (option.get_positional()) return option.get_single_name();
  const std::string value = option.get_items_expected_max() > 0 ? " " + option.get_type_name() : "";
  return option.get_name() + value;
}

std::string entry(const std::string& term, const std::string& text) {
  return fmt::format(".TP\n.B {}\n{}\n", roff(term), roff(text));
}

std::string manual_page(const CLI::App& program) {
  std::string text = fmt::format(
      ".TH APSIS 1 \"\" \"apsis {}\" \"User Commands\"\n.SH NAME\napsis \\- stiff relaxation and kinetic "
      "equations\n"
      ".SH SYNOPSIS\n.B apsis\n.I command\n[options]\n.SH DESCRIPTION\n{}\n.SH COMMANDS\n",
      version(), roff(program.get_description()));
  for (const auto* command : commands_of(program))
    text += entry(command->get_name(), command->get_description());
  for (const auto* command : commands_of(program)) {
    text += fmt::format(".SH apsis {}\n{}\n", roff(command->get_name()), roff(command->get_description()));
    for (const auto* option : options_of(*command))
      text += entry(usage_of(*option), option->get_description());
  }
  return text + fmt::format(".SH EXIT STATUS\n{}\n", roff(program.get_footer()));
}

std::string document(const CLI::App& program) {
  using json = nlohmann::ordered_json;
  json commands = json::array();
  for (const auto* command : commands_of(program)) {
    json options = json::array();
    for (const auto* option : options_of(*command))
      options.push_back({{"usage", usage_of(*option)},
                         {"description", option->get_description()},
                         {"required", option->get_required()},
                         {"default", option->get_default_str()}});
    const std::string more = command->get_footer();
    commands.push_back({{"name", command->get_name()},
                        {"description", command->get_description()},
                        {"options", options},
                        {"more", more == program.get_footer() ? "" : more}});
  }
  return json{{"version", version()},
              {"description", program.get_description()},
              {"commands", commands},
              {"exit_codes", program.get_footer()}}
             .dump(2) +
         "\n";
}

/// Returns the long options of a command.
std::string words_of(const CLI::App& command) {
  std::vector<std::string> words;
  for (const auto* option : options_of(command))
    for (const auto& name : option->get_lnames()) words.push_back("--" + name);
  return fmt::format("{}", fmt::join(words, " "));
}

std::string bash_completion(const CLI::App& program) {
  std::string options, arguments;
  std::vector<std::string> names;
  for (const command_entry* command : commands_in_order()) {
    names.push_back(command->name);
    options += fmt::format("    {}) words='{}' ;;\n", command->name,
                           words_of(*program.get_subcommand(command->name)));
    if (!command->completion.empty())
      arguments += fmt::format("      {}) words=\"{}\" ;;\n", command->name, command->completion);
  }
  return fmt::format(
      "# Completion of apsis for bash, written by: apsis manual --format bash\n"
      "_apsis() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} words=''\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W '{} --help --version' -- \"$word\")\n"
      "    return\n"
      "  fi\n"
      "  case ${{COMP_WORDS[1]}} in\n{}  esac\n"
      "  if [[ $word != -* ]]; then\n"
      "    case ${{COMP_WORDS[1]}} in\n{}    esac\n"
      "  fi\n"
      "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
      "}}\n"
      "complete -o default -F _apsis apsis\n",
      fmt::join(names, " "), options, arguments);
}

action define(CLI::App& command) {
  auto format = std::make_shared<std::string>("man");
  command.add_option("--format", *format, "man, bash, or json for all commands with their options")
      ->check(CLI::IsMember({"man", "bash", "json"}));
  return [format, &program = *command.get_parent()] {
    print(*format == "man"    ? manual_page(program)
          : *format == "bash" ? bash_completion(program)
                              : document(program));
    return 0;
  };
}

}  // namespace
}  // namespace manual_command

extern const command_entry command_manual;
const command_entry command_manual = {
    .name = "manual",
    .summary = "Print the manual page, or the command-line completion for bash",
    .place = 110,
    .define = manual_command::define};

}  // namespace apsis::app
