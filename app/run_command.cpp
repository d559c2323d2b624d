#include "commands.hpp"
#include "run_profile.hpp"
#include "run_session.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/output/case_json.hpp>

#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

namespace apsis::app {
namespace {

int run(const run_options& options) {
  run_session session(options);
  const run_end end = session.run();
  const simulation& computed = session.computed();
  std::optional<run_profile> profile;
  if (options.profile)
    profile = finish_profile(computed.summary().wall_s, static_cast<std::size_t>(computed.cells()) *
                                                            static_cast<std::size_t>(computed.components()));
  if (options.json) {
    auto out = to_json(computed, session.records());
    if (profile) out["profile"] = to_json(*profile);
    print(json_text(out) + "\n");
  } else {
    print(summary_text(computed, end) + (profile ? profile_text(*profile) : ""));
  }
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
  command->add_flag("--profile", options->profile,
                    "tell how long each kernel took, and how near it came to the ceilings of this machine");
  command->add_option("--restart", options->restart, "go on from a checkpoint.h5 of the same case");
  command
      ->add_option("--wall", options->wall,
                   "stop after this many seconds with a checkpoint, as if interrupted (exit code 130)")
      ->check(CLI::PositiveNumber);
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace apsis::app
