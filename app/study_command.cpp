#include "drawing.hpp"
#include "interrupt.hpp"
#include "print.hpp"
#include "study_command.hpp"
#include "threads_option.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/version.hpp>
#include <apsis/output/json_text.hpp>
#include <apsis/output/provenance.hpp>

#include <fmt/format.h>

namespace apsis::app {
namespace {

std::string state_of(const study_results& results) {
  if (!results.complete) return "interrupted";
  return results.failures > 0 ? "some runs failed" : "complete";
}

void draw_into(const result_folder& folder) {
  try {
    draw("plot", {folder.path().string(), "--out", folder.path().string()});
  } catch (const io_error& problem) {
    log::warning(problem.what());  // `apsis plot` can draw picture.json later
  } catch (const interruption&) {
    return;
  }
}

}  // namespace

void add_study_options(CLI::App& command, study_options& given, const std::string& name,
                       const std::string& row, const std::string& of_threads) {
  command
      .add_option("CASE", given.case_name, "a case file, or the name of a built-in case (apsis list cases)")
      ->required();
  command.add_option("key=value", given.overrides, "override key=value for every run");
  command.add_option(
      "--out", given.out,
      fmt::format("folder for {0}.csv, {0}.json, and the plot as picture.json and {0}.png", name));
  command.add_flag("--json", given.json, fmt::format("print only a JSON array with one object per {}", row));
  add_threads(command, given.threads, of_threads, "all processors");
}

void write_study(result_folder& folder, const study_results& results) {
  const bool drawable = !results.drawn.panels.empty();
  const nlohmann::ordered_json manifest = {{"apsis", version()},      {"state", state_of(results)},
                                           {"written", time_stamp()}, {"study", results.subject},
                                           {"build", build_info()},   {"machine", machine_info()}};
  folder.prepare_text(results.name + ".csv", results.csv);
  folder.prepare_text(results.name + ".json", json_text(results.rows) + "\n");
  if (drawable) folder.prepare_text("picture.json", json_text(to_json(results.drawn)) + "\n");
  folder.prepare_text(result_folder::manifest, json_text(manifest) + "\n");
  folder.commit();
  if (drawable && !interrupted()) draw_into(folder);
}

void print_study(const study_options& given, const nlohmann::ordered_json& rows, const std::string& text) {
  print(given.json ? json_text(rows) + "\n" : text);
}

study_control shown_in(progress_bar& bar) {
  study_control control;
  control.stop = interrupted;
  control.progress = [&bar](double part, const std::string& what) { bar.update(part, what); };
  return control;
}

}  // namespace apsis::app
