#include "command_registry.hpp"
#include "interrupt.hpp"
#include "progress_bar.hpp"
#include "study_command.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/warnings_once.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/output/result_folder.hpp>
#include <apsis/study/convergence_report.hpp>

#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace converge_command {
namespace {

using json = nlohmann::ordered_json;

struct options : study_options {
  std::string norm = "l2", quantity;
  std::vector<std::string> vary;
  std::optional<std::string> reference;
};

convergence_study study_of(const options& given) {
  convergence_study study{given.case_name};
  study.overrides = given.overrides;
  for (const auto& text : given.vary) study.vary.push_back(parse_vary(text));
  if (given.reference) study.reference = parse_reference(*given.reference);
  study.norm = find_norm(given.norm);
  study.quantity = given.quantity;
  return study;
}

study_results results_of(const options& given, const convergence_table& table) {
  const json subject = {{"case", given.case_name},  {"overrides", given.overrides},
                        {"vary", given.vary},       {"reference", given.reference.value_or("automatic")},
                        {"measure", table.measure}, {"runs", table.runs}};
  return {"converge",        to_csv(table),  to_json(table),  subject,
          to_picture(table), table.complete, table.failures()};
}

/// Runs the study; returns false if it was interrupted.
bool run_all_of(convergence& study) {
  progress_bar bar;
  try {
    study.run(shown_in(bar));
  } catch (const study_interrupted&) {
    return false;
  }
  return true;
}

int converge(const options& given) {
  const warnings_once once;
  watch_for_interrupts("the current step of every run; finished runs are retained");
  set_threads(given.threads.value_or(default_threads()));
  convergence study(study_of(given));
  std::optional<result_folder> folder;
  if (given.out) folder.emplace(*given.out);
  const convergence_table plan = study.table();
  log::info(fmt::format("{}: {} runs; {}", given.case_name, plan.runs, plan.measure));
  const bool finished = run_all_of(study);
  const convergence_table table = study.table();
  if (folder) write_study(*folder, results_of(given, table));
  print_study(given, to_json(table), to_text(table));
  if (!finished || interrupted()) {
    const auto all = static_cast<std::size_t>(table.runs);
    log::warning(fmt::format("interrupted ({} of {} runs are finished); {}", study.finished_runs(), all,
                             folder ? fmt::format("apsis plot {} draws them", folder->path().string())
                                    : std::string("the table has their rows")));
    return static_cast<int>(exit_code::interrupted);
  }
  if (const long failed = table.failures(); failed > 0)
    throw numerical_error(
        fmt::format("{} run(s) have no error (they or their references failed, the others are valid); see "
                    "the messages in the table",
                    failed));
  return 0;
}

constexpr const char* description =
    "Runs a case on a grid of values of its keys and measures errors and rates.\n\n"
    "  apsis converge paper/decay --vary time.method=imdrk-1-2,imdrk-2-3 --vary time.dt=1/16..1/1024\n"
    "  apsis converge paper/bgk-accuracy --vary model.epsilon=1,1e-6 --vary space.cells=20,40,80\n"
    "  apsis converge paper/ode --vary time.dt=1/16..1/1024 --reference md-imex-6-3@1e-5 --norm l1\n\n"
    "The refined key is the last varied one of space.cells, time.dt, time.cfl, time.safety and "
    "velocity.points, or, if none of them is varied, the last key with positive numbers. The other keys form "
    "blocks, whose rows go from coarse to fine. The rate is the slope of the error against the cell length, "
    "the step, or that number. A failed run leaves a message in its row, and the exit code is 3.";

action define(CLI::App& command) {
  auto given = std::make_shared<options>();
  command.footer(description);
  add_study_options(command, *given, "converge", "run", "number of simultaneous runs");
  command
      .add_option("--vary", given->vary,
                  "key=v1,v2,...: a key and its values, 20..160 stands for 20,40,80,160; several --vary run "
                  "all combinations")
      ->required()
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option("--reference", given->reference,
                     "reference of the errors: exact (default if the model has it), next (the next finer "
                     "run; default otherwise), time (1/8 of the smallest step), space+time (three times the "
                     "cells, a third of the step), METHOD@STEP, or key=value,... for a run with these keys");
  command.add_option("--norm", given->norm, "l1, l2 or linf")->capture_default_str();
  command.add_option("--quantity", given->quantity,
                     "compare a macroscopic field, such as rho, instead of the full state");
  return [given] { return converge(*given); };
}

}  // namespace
}  // namespace converge_command

extern const command_entry command_converge;
const command_entry command_converge = {.name = "converge",
                                        .summary = "Run a case on many meshes or steps: errors and rates",
                                        .place = 20,
                                        .completion = completed_from_list("cases"),
                                        .define = converge_command::define};

}  // namespace apsis::app
