#include "command_registry.hpp"
#include "interrupt.hpp"
#include "loads_text.hpp"
#include "option_values.hpp"
#include "print.hpp"
#include "processes.hpp"
#include "progress_bar.hpp"
#include "run_profile.hpp"
#include "run_report.hpp"
#include "threads_option.hpp"

#include <apsis/config/case_explanation.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/device/find_device.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/exec/interruption.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/output/json_text.hpp>
#include <apsis/output/provenance.hpp>
#include <apsis/run/session.hpp>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace run_command {
namespace {

/// The command line of `apsis run`.
struct run_options {
  std::string case_name;
  std::vector<std::string> overrides;
  session_options session;
  std::optional<int> threads;
  std::optional<std::string> device;
  bool json = false, profile = false, explain = false;
};

/// Returns the progress, such as "step 1234/2900  t = 0.21  min 1.20e-31".
std::string step_text(const simulation& now) {
  if (now.config().steady_state.tolerance)
    return fmt::format("iteration {}  residual {:.2e}  change {:.2e}{}", now.step(),
                       now.last().residual.front(), now.last().change, loads_text(now));
  return fmt::format("step {}/{}  t = {:.4g}  min {:.2e}", now.step(), now.steps_total(), now.t(),
                     now.last().min_value);
}

/// Returns the share of the work that is done. In an iteration the work is the number of digits of
/// the residual.
double share_done(const simulation& now) {
  const auto& tolerance = now.config().steady_state.tolerance;
  if (!tolerance) return now.t() / now.config().time.end;
  const double residual = now.last().residual.front();
  return residual > 0.0 && residual < 1.0 ? std::log(residual) / std::log(*tolerance) : 0.0;
}

int code_of(run_end end) {
  return static_cast<int>(end == run_end::complete ? exit_code::success : exit_code::interrupted);
}

/// Seconds after a signal for which a process waits for another one; writing takes less time.
constexpr double longest_wait = 60.0;

int run_on(const std::shared_ptr<communicator>& processes, run_options options) {
  processes->limit_waiting(interrupted, longest_wait);
  case_config config;
  run_collectively(*processes, [&] { config = load_case(options.case_name, options.overrides); });
  set_threads(options.threads.value_or(threads_for(config, *processes)));
  progress_bar bar;
  options.session.processes = processes;
  run_collectively(*processes, [&] {
    if (options.device) options.session.on = open_device(*options.device, processes->number_here());
  });
  options.session.command = command_line();
  options.session.stop = interrupted;
  if (processes->is_root())
    options.session.watch = [&bar](const simulation& now) {
      if (bar.due()) bar.update(share_done(now), step_text(now));
    };
  options.session.stepped = [&bar] { bar.finish(); };
  std::optional<run_session> prepared;
  {
    const interruptible before_steps([] {
      if (interrupted()) throw interrupted_error();
    });
    prepared.emplace(config, options.session);
  }
  run_session& session = *prepared;
  if (options.explain)
    log::info(fmt::format("values of {}:\n{}", config.source, explanation_text(session.computed().config())));
  if (options.profile) profile::start();
  const run_end end = session.run();
  const simulation& computed = session.computed();
  std::optional<run_profile> profile;
  if (options.profile)
    profile =
        finish_profile(computed.summary().wall_s, static_cast<std::size_t>(computed.summary().phase_points));
  if (options.json) {
    auto out = to_json(computed, session.records(), session.warnings());
    if (!processes->is_root()) return code_of(end);
    if (profile) out["profile"] = to_json(*profile);
    print(json_text(out) + "\n");
  } else {
    const std::string summary = summary_text(computed, end, session.records());
    if (processes->is_root()) print(summary + (profile ? profile_text(*profile) : ""));
  }
  return code_of(end);
}

int run(const run_options& options) {
  // The handler is set first, so that an interrupt before the first step has the same effect as a later one.
  watch_for_interrupts(reports_errors() ? "the current step, and a checkpoint if there is a folder (--out)"
                                        : nullptr);
  return on_all_processes(
      [&](const std::shared_ptr<communicator>& processes) { return run_on(processes, options); });
}

action define(CLI::App& command) {
  auto options = std::make_shared<run_options>();
  command
      .add_option("CASE", options->case_name,
                  "a case file, or the name of a built-in case (apsis list cases)")
      ->required();
  command.add_option("key=value", options->overrides, "override key=value of the case (apsis show case)");
  command.add_option("--out", options->session.out,
                     "folder for the results; without it no files are written");
  command.add_flag("--json", options->json, "print only one JSON object on standard output");
  add_threads(command, options->threads, "threads to use",
              "all processors for a large case and 1 for a small one");
  command.add_option(
      "--device", options->device,
      "run on a device of this machine, by its number (0) or place (cuda:0) in apsis info; results "
      "have the bits of the host");
  command.add_flag("--explain", options->explain,
                   "log every value of the case, with a mark whether it is given, a default or derived");
  command.add_flag("--profile", options->profile,
                   "report the time of each kernel and its fraction of the ceilings of this machine");
  command.add_option("--restart", options->session.restart, "continue from a checkpoint.h5 of the same case");
  command
      .add_option("--wall", options->session.wall,
                  "stop after this many seconds with a checkpoint, as if interrupted (exit code 130)")
      ->check(positive_number());
  return [options] { return run(*options); };
}

}  // namespace
}  // namespace run_command

extern const command_entry command_run;
const command_entry command_run = {.name = "run",
                                   .summary = "Run a case and write its results",
                                   .place = 10,
                                   .completion = completed_from_list("cases"),
                                   .shares_work = true,
                                   .define = run_command::define};

}  // namespace apsis::app
