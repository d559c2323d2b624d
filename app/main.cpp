#include "command_registry.hpp"
#include "interrupt.hpp"
#include "option_values.hpp"
#include "processes.hpp"
#include "usage_error.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/printable.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/core/version.hpp>
#include <apsis/exec/memory.hpp>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace apsis::app {

namespace {

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

int run_program(int argc, char** argv) {
  CLI::App program(
      "Apsis: stiff relaxation and kinetic equations u_t = T(u) + Q(u)/epsilon with positivity-preserving, "
      "asymptotic-preserving multi-derivative IMEX Runge-Kutta methods.",
      "apsis");
  program.set_version_flag("--version", std::string("apsis ") + version());
  program.footer(
      "Exit codes: 0 success, 1 internal error, 2 input, 3 numerical failure or broken promise, 4 file or "
      "folder, 5 claims do not hold, 130 interrupted (after a checkpoint).");
  program.require_subcommand(1);
  action chosen;
  for (const command_entry* command : commands_in_order()) {
    CLI::App* added = program.add_subcommand(command->name, command->summary);
    // The action is only recorded during parsing, so that nothing runs before the whole line is valid.
    added->callback([&chosen, command, run = command->define(*added)] {
      chosen = [command, run] {
        if (!command->shares_work) refuse_several_processes(command->name.c_str());
        return run();
      };
    });
  }
  check_option_values(program);
  const std::vector<std::string> names = command_names(program);
  if (argc < 2) throw input_error("command line: no command (one of them is needed); " + suggest("", names));
  check_first_argument(argv[1], names);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& problem) {
    if (problem.get_exit_code() == 0) return program.exit(problem);
    refuse_usage(program, problem);
  }
  return chosen();
}

/// Reopens descriptors 0 to 2 if the caller closed them. Otherwise the next file, perhaps one of results,
/// would get their number and receive every message. Writing to the reopened descriptors fails, as to
/// closed ones.
void occupy_standard_descriptors() {
  for (const int id : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(id, F_GETFD) < 0) static_cast<void>(open("/dev/null", O_RDONLY));
}

int fail(exit_code code, const std::string& message) {
  // Several processes end with the same error, and one of them reports it. If standard error cannot be
  // written, only the exit code reports the error.
  if (reports_errors()) std::fputs(fmt::format("error: {}\n", printable(message)).c_str(), stderr);
  return static_cast<int>(code);
}

int run_and_report_errors(int argc, char** argv) {
  try {
    try {
      return run_program(argc, argv);
    } catch (const error&) {
      share_early_error(std::current_exception());
      throw;
    }
  } catch (const interruption&) {
    return static_cast<int>(exit_code::interrupted);
  } catch (const error& problem) {
    return fail(problem.code(), problem.what());
  } catch (const std::bad_alloc&) {
    return fail(exit_code::numerical,
                "not enough memory (the state and its stages do not fit); use fewer cells or velocities");
  } catch (const std::exception& problem) {
    return fail(exit_code::internal,
                fmt::format("internal error: {} (a bug in apsis); please report it", problem.what()));
  }
}

}  // namespace
}  // namespace apsis::app

int main(int argc, char** argv) {
  apsis::app::occupy_standard_descriptors();
  apsis::keep_freed_memory();
  // A file that exceeds its limit (ulimit -f) is an output error and must not kill the process.
  std::signal(SIGXFSZ, SIG_IGN);
  const int code = apsis::app::run_and_report_errors(argc, argv);
  // All processes that arrive here end in the same way. Only the process that reports errors returns the
  // code. A launcher kills all others as soon as one returns a code other than 0, perhaps before the error
  // is reported.
  return apsis::app::reports_errors() ? code : 0;
}
