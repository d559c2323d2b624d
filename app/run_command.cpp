#include "commands.hpp"
#include "run_session.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/output/case_json.hpp>

#include <memory>

#include <nlohmann/json.hpp>

namespace apsis::app {
namespace {

int run(const run_options& options) {
  run_session session(options);
  const run_end end = session.run();
  print(options.json ? json_text(to_json(session.computed(), session.records())) + "\n"
                     : summary_text(session.computed(), end));
  return static_cast<int>(end == run_end::complete ? exit_code::success : exit_code::interrupted);
}

}  // namespace

void add_run(CLI::App& program, action& chosen) {
  auto options = std::make_shared<run_options>();
  CLI::App* command = program.add_subcommand("run", "Run a case and write its results");
  command
      ->add_option("CASE", options->case_name,
                   "a case file, or the name of a built-in case (apsis list cases)")
      ->required();
  command->add_option("key=value", options->overrides,
                      "keys of the case that take another value (apsis show case)");
  command->add_option("--out", options->out, "folder for the results; without it nothing is written");
  command->add_flag("--json", options->json, "print one JSON object on standard output, and nothing else");
  command
      ->add_option("--threads", options->threads,
                   "threads to use, 0 for all cores; results do not depend on it")
      ->check(CLI::Range(0, 1024));
  command->add_option("--restart", options->restart, "go on from a checkpoint.h5 of the same case");
  command
      ->add_option("--wall", options->wall,
                   "stop after this many seconds with a checkpoint, as if interrupted (exit code 130)")
      ->check(CLI::PositiveNumber);
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace apsis::app
