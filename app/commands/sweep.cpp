#include "command_registry.hpp"
#include "interrupt.hpp"
#include "progress_bar.hpp"
#include "study_command.hpp"
#include "text_table.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/warnings_once.hpp>
#include <apsis/exec/parallel.hpp>
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

struct options : study_options {
  std::string vary;
  int points = 9;
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

long missing(const sweep_table& table) {
  return std::count_if(table.rows.begin(), table.rows.end(), [](const sweep_row& row) { return !row.found; });
}

study_results results_of(const options& given, const sweep_table& table) {
  const json subject = {{"case", given.case_name},
                        {"overrides", given.overrides},
                        {"vary", given.vary},
                        {"measure", "steady states"},
                        {"runs", table.rows.size()}};
  return {"sweep",           to_csv(to_table(table), {"iterations"}),
          to_json(table),    subject,
          to_picture(table), table.complete,
          missing(table)};
}

int sweep(const options& given) {
  const warnings_once once;
  watch_for_interrupts("the current iteration; steady states found before are retained");
  set_threads(given.threads.value_or(default_threads()));
  const varied_key varied = parse_sweep(given.vary, given.points);
  std::optional<result_folder> folder;
  if (given.out) folder.emplace(*given.out);
  log::info(fmt::format("{}: {} steady states", given.case_name, varied.values.size()));
  progress_bar bar;
  const sweep_table table = run_sweep(given.case_name, given.overrides, varied, shown_in(bar));
  bar.finish();
  if (folder) write_study(*folder, results_of(given, table));
  print_study(given, to_json(table), text_of(table));
  if (!table.complete) {
    log::warning(fmt::format("interrupted ({} of {} steady states are found); the table has their rows",
                             table.rows.size(), varied.values.size()));
    return static_cast<int>(exit_code::interrupted);
  }
  if (const long failed = missing(table); failed > 0)
    throw numerical_error(fmt::format(
        "{} steady state(s) are not found (the others are valid); see the messages in the table", failed));
  return 0;
}

constexpr const char* description =
    "Finds the steady states of a case for many values of a key, each starting from the previous one.\n\n"
    "  apsis sweep gas/couette --vary delta=0.01..100\n"
    "  apsis sweep gas/cavity --vary U=0.1,0.2,0.5 parameters.delta=10 --out results/lid\n\n"
    "A range a..b has --points values, in constant ratios where it is wide. A key without a dot is one of "
    "the table [parameters]. Where the iteration from the previous state fails, another one starts from the "
    "initial data. If that fails too, the row has a message, and the exit code is 3.";

action define(CLI::App& command) {
  auto given = std::make_shared<options>();
  command.footer(description);
  add_study_options(command, *given, "sweep", "steady state", "threads to use");
  command.add_option("--vary", given->vary, "key=v1,v2,... or key=a..b: a key and its values")->required();
  command.add_option("--points", given->points, "number of values of a range")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
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
