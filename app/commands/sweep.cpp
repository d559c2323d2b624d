#include "command_registry.hpp"
#include "drawing.hpp"
#include "interrupt.hpp"
#include "print.hpp"
#include "progress_bar.hpp"
#include "text_table.hpp"
#include "threads_option.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/version.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/output/json_text.hpp>
#include <apsis/output/provenance.hpp>
#include <apsis/output/result_folder.hpp>
#include <apsis/study/steady_sweep.hpp>

#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace sweep_command {
namespace {

using json = nlohmann::ordered_json;

struct options {
  std::string case_name, vary;
  std::vector<std::string> overrides;
  int points = 9;
  std::optional<std::string> out;
  std::optional<int> threads;
  bool json = false;
};

std::string text_of(const sweep_table& table) {
  const auto visible = visible_fluxes(table);
  text_table text(std::vector<bool>(4 + visible.size(), false));
  std::vector<std::string> head = {table.key, "iterations", "cpu_s", "residual"};
  for (const std::size_t k : visible) head.push_back(table.fluxes[k]);
  text.add(head);
  for (const sweep_row& row : table.rows) {
    std::vector<std::string> cells = {row.value, fmt::format("{}", row.iterations),
                                      fmt::format("{:.2f}", row.cpu_s), fmt::format("{:.1e}", row.residual)};
    for (const std::size_t k : visible) cells.push_back(row.found ? fmt::format("{:.6g}", row.flux[k]) : "-");
    text.add(cells);
    if (!row.found) text.add_line("  " + row.problem);
  }
  return table.title + "\n" + text.text();
}

std::ptrdiff_t missing(const sweep_table& table) {
  return std::count_if(table.rows.begin(), table.rows.end(), [](const sweep_row& row) { return !row.found; });
}

std::string state_of(const sweep_table& table) {
  if (!table.complete) return "interrupted";
  return missing(table) > 0 ? "some runs failed" : "complete";
}

void write_results(result_folder& folder, const options& given, const sweep_table& table) {
  const picture drawn = to_picture(table);
  folder.prepare_text("sweep.csv", to_csv(to_table(table), {"iterations"}));
  folder.prepare_text("sweep.json", json_text(to_json(table)) + "\n");
  if (!drawn.panels.empty()) folder.prepare_text("picture.json", json_text(to_json(drawn)) + "\n");
  const json manifest = {
      {"apsis", version()},
      {"state", state_of(table)},
      {"written", time_stamp()},
      {"sweep", {{"case", given.case_name}, {"overrides", given.overrides}, {"vary", given.vary}}},
      {"build", build_info()},
      {"machine", machine_info()}};
  folder.prepare_text(result_folder::manifest, json_text(manifest) + "\n");
  folder.commit();
  if (drawn.panels.empty() || interrupted()) return;
  try {
    draw("plot", {folder.path().string(), "--out", folder.path().string()});
  } catch (const io_error& problem) {
    log::warning(problem.what());  // the picture can be drawn from picture.json at any time
  } catch (const interruption&) {
    return;
  }
}

int sweep(const options& given) {
  watch_for_interrupts("the current iteration; steady states found before are retained");
  set_threads(given.threads.value_or(default_threads()));
  const varied_key varied = parse_sweep(given.vary, given.points);
  std::optional<result_folder> folder;
  if (given.out) folder.emplace(*given.out);
  log::info(fmt::format("{}: {} steady states", given.case_name, varied.values.size()));
  progress_bar bar;
  study_control control;
  control.stop = interrupted;
  control.progress = [&bar](double part, const std::string& what) { bar.update(part, what); };
  const sweep_table table = run_sweep(given.case_name, given.overrides, varied, control);
  bar.finish();
  if (folder) write_results(*folder, given, table);
  print(given.json ? json_text(to_json(table)) + "\n" : text_of(table));
  if (!table.complete) {
    log::warning(fmt::format("interrupted ({} of {} steady states are found); the table has their rows",
                             table.rows.size(), varied.values.size()));
    return static_cast<int>(exit_code::interrupted);
  }
  if (const auto failed = missing(table); failed > 0)
    throw numerical_error(fmt::format(
        "{} steady state(s) are not found (the others are valid); see the messages in the table", failed));
  return 0;
}

constexpr const char* description =
    "Finds the steady states of a case for many values of a key, each from the one before.\n\n"
    "  apsis sweep gas/couette --vary delta=0.01..100\n"
    "  apsis sweep gas/cavity --vary U=0.1,0.2,0.5 parameters.delta=10 --out results/lid\n\n"
    "A range a..b has --points values, in constant ratios where it is wide. A key without a dot is one of "
    "the "
    "table [parameters]. A state that is not found from the one before is sought from the initial data; if "
    "it "
    "is not found either, its row has a message, and the exit code is 3.";

action define(CLI::App& command) {
  auto given = std::make_shared<options>();
  command.footer(description);
  command
      .add_option("CASE", given->case_name, "a case file, or the name of a built-in case (apsis list cases)")
      ->required();
  command.add_option("key=value", given->overrides, "override key=value for every run");
  command.add_option("--vary", given->vary, "key=v1,v2,... or key=a..b: a key and its values")->required();
  command.add_option("--points", given->points, "number of values of a range")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command.add_option("--out", given->out,
                     "folder for sweep.csv, sweep.json, and the plot as picture.json and sweep.png");
  command.add_flag("--json", given->json, "print only a JSON array with one object per steady state");
  add_threads(command, given->threads, "threads to use", "all processors");
  return [given] { return sweep(*given); };
}

}  // namespace
}  // namespace sweep_command

extern const command_entry command_sweep;
const command_entry command_sweep = {.name = "sweep",
                                     .summary = "Find the steady states of a case for many values of a key",
                                     .place = 25,
                                     .completion = completed_from_list("cases"),
                                     .define = sweep_command::define};

}  // namespace apsis::app
