#include "command_registry.hpp"
#include "drawing.hpp"
#include "interrupt.hpp"
#include "print.hpp"
#include "progress_bar.hpp"
#include "threads_option.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/version.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/output/json_text.hpp>
#include <apsis/output/provenance.hpp>
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

struct options {
  std::string case_name, norm = "l2", quantity;
  std::vector<std::string> overrides, vary;
  std::optional<std::string> reference, out;
  std::optional<int> threads;
  bool json = false;
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

std::string state_of(const convergence_table& table) {
  if (!table.complete) return "interrupted";
  return table.failures() > 0 ? "some runs failed" : "complete";
}

json manifest(const options& given, const convergence_table& table) {
  return {{"apsis", version()},
          {"state", state_of(table)},
          {"written", time_stamp()},
          {"study",
           {{"case", given.case_name},
            {"overrides", given.overrides},
            {"vary", given.vary},
            {"reference", given.reference.value_or("automatic")},
            {"measure", table.measure},
            {"runs", table.runs}}},
          {"build", build_info()},
          {"machine", machine_info()}};
}

void write_results(result_folder& folder, const options& given, const convergence_table& table) {
  const picture plot = to_picture(table);
  const bool drawable = !plot.panels.empty();
  folder.prepare_text("converge.csv", to_csv(table));
  folder.prepare_text("converge.json", json_text(to_json(table)) + "\n");
  if (drawable) folder.prepare_text("picture.json", json_text(to_json(plot)) + "\n");
  folder.prepare_text(result_folder::manifest, json_text(manifest(given, table)) + "\n");
  folder.commit();
  if (!drawable || interrupted()) return;
  try {
    draw("plot", {folder.path().string(), "--out", folder.path().string()});
  } catch (const io_error& problem) {
    // The numbers exist, and the picture can be drawn from picture.json at any time.
    log::warning(problem.what());
  } catch (const interruption&) {
    return;  // also after an interrupt
  }
}

/// Returns false if it was interrupted.
bool run_all_of(convergence& study) {
  progress_bar bar;
  study_control control;
  control.stop = interrupted;
  control.progress = [&bar](double part, const std::string& what) { bar.update(part, what); };
  try {
    study.run(control);
  } catch (const study_interrupted&) {
    return false;
  }
  return true;
}

int converge(const options& given) {
  watch_for_interrupts("the current step of every run; finished runs are retained");
  set_threads(given.threads.value_or(default_threads()));
  convergence study(study_of(given));
  std::optional<result_folder> folder;
  if (given.out) folder.emplace(*given.out);
  const convergence_table plan = study.table();
  log::info(fmt::format("{}: {} runs; {}", given.case_name, plan.runs, plan.measure));
  const bool finished = run_all_of(study);
  const convergence_table table = study.table();
  if (folder) write_results(*folder, given, table);
  print(given.json ? json_text(to_json(table)) + "\n" : to_text(table));
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
  command
      .add_option("CASE", given->case_name, "a case file, or the name of a built-in case (apsis list cases)")
      ->required();
  command.add_option("key=value", given->overrides, "override key=value for every run");
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
  command.add_option("--out", given->out,
                     "folder for converge.csv, converge.json, and the plot as picture.json and converge.png");
  command.add_flag("--json", given->json, "print only a JSON array with one object per run");
  add_threads(command, given->threads, "number of simultaneous runs", "all processors");
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
