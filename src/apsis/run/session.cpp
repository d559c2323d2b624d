#include <apsis/run/session.hpp>

#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/output/case_json.hpp>

#include <cmath>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis {
namespace {

// What may differ between a run and its continuation: nothing that enters a step.
std::string essential_text(case_config config) {
  config.title.clear();
  config.output = {};
  config.time.end = 1.0;
  return to_toml(config);
}

void check_same_case(const case_config& mine, const std::string& saved_text, const std::string& path) {
  std::istringstream here(essential_text(mine));
  std::istringstream there(essential_text(parse_case(saved_text, path)));
  for (std::string a, b; std::getline(here, a) || std::getline(there, b);) {
    if (b.empty()) std::getline(there, b);
    if (a != b)
      throw input_error(fmt::format(
          "'{}' belongs to another case ('{}' there, '{}' here) restart with the case it was written for",
          path, b, a));
    a.clear();
    b.clear();
  }
}

}  // namespace

run_session::run_session(case_config configured, session_options options)
    : options_(std::move(options)), simulation_(std::move(configured)) {
  if (options_.restart)
    resume(*options_.restart);
  else
    records_ = std::make_unique<run_records>(simulation_);
  const case_config& config = simulation_.config();
  if (config.output.every > 0.0) snapshots_ = static_cast<long>(simulation_.t() / config.output.every + 1e-9);
  if (options_.out) folder_ = std::make_unique<result_folder>(*options_.out);
  if (!folder_ && config.output.checkpoint_every > 0)
    log::warning("no checkpoints are written (output.checkpoint_every needs a folder) give one with --out");
  log::info(fmt::format("{}: about {} steps of {}; {}", config.source, simulation_.steps_total(),
                        config.time.method, simulation_.promises().text()));
}

void run_session::resume(const std::string& path) {
  const checkpoint saved = read_checkpoint(path);
  check_same_case(simulation_.config(), saved.case_text, path);
  if (saved.cells != static_cast<std::uint64_t>(simulation_.cells()) ||
      saved.components != static_cast<std::uint64_t>(simulation_.components()))
    throw input_error(fmt::format(
        "'{}' holds {} x {} unknowns (the case has {} x {}) restart with the case it was written for", path,
        saved.cells, saved.components, simulation_.cells(), simulation_.components()));
  const saved_run state = to_saved_run(saved);
  if (!(state.t < simulation_.config().time.end))
    throw input_error(fmt::format("'{}' is already at t = {} (time.end is {}) give a later time.end", path,
                                  state.t, simulation_.config().time.end));
  simulation_.restore(state);
  records_ = std::make_unique<run_records>(simulation_, saved);
}

run_end run_session::run() {
  try {
    loop();
  } catch (const numerical_error& failure) {
    if (options_.stepped) options_.stepped();
    save_failure(failure.what());
    throw;
  }
  if (options_.stepped) options_.stepped();
  finish_records();
  if (folder_)
    write_results(*folder_, end_, "");
  else if (end_ != run_end::complete)
    log::warning("nothing was saved (a checkpoint needs a folder) give one with --out");
  return end_;
}

void run_session::finish_records() {
  shown_ = std::make_unique<run_records>(*records_);
  const auto& taken = shown_->fields().snapshots;
  if (taken.empty() || taken.back().t != simulation_.t()) shown_->add_snapshot(simulation_);
}

void run_session::loop() {
  if (options_.watch) options_.watch(simulation_);
  while (!simulation_.finished()) {
    if (options_.stop && options_.stop()) {
      end_ = run_end::interrupted;
      return;
    }
    if (options_.wall && std::chrono::duration<double>(clock::now() - start_).count() >= *options_.wall) {
      end_ = run_end::wall_time;
      return;
    }
    simulation_.advance();
    after_step();
  }
}

void run_session::after_step() {
  const case_config& config = simulation_.config();
  const step_record& last = simulation_.last();
  records_->add_step(last);
  if (config.output.every > 0.0) {
    // A step may pass several snapshot times; the state is then kept once.
    const auto passed = static_cast<long>(std::floor(last.t / config.output.every + 1e-9));
    if (passed > snapshots_) records_->add_snapshot(simulation_);
    snapshots_ = passed;
  }
  if (checkpoint_is_due()) publish_checkpoint();
  if (options_.watch) options_.watch(simulation_);
}

bool run_session::checkpoint_is_due() const {
  if (!folder_) return false;
  const auto& output = simulation_.config().output;
  const std::chrono::duration<double, std::ratio<60>> since = clock::now() - last_checkpoint_;
  return (output.checkpoint_every > 0 && simulation_.step() % output.checkpoint_every == 0) ||
         (output.checkpoint_minutes > 0.0 && since.count() >= output.checkpoint_minutes);
}

void run_session::publish_checkpoint() {
  folder_->publish("checkpoint.h5", [&](const std::string& path) {
    write_checkpoint(path, make_checkpoint(simulation_, *records_));
  });
  last_checkpoint_ = clock::now();
}

void run_session::write_results(result_folder& folder, run_end end, const std::string& message) {
  const solution final_state = make_solution(simulation_, *shown_);
  folder.prepare_text("history.csv", to_csv(shown_->history(), {"step", "negative_values"}));
  folder.prepare_text("fields.csv", to_csv(to_table(shown_->fields())));
  folder.prepare("solution.h5", [&](const std::string& path) { write_solution(path, final_state); });
  folder.prepare_text("solution.xdmf", solution_xdmf(final_state));
  const bool stopped = end == run_end::interrupted || end == run_end::wall_time;
  if (stopped || (end == run_end::complete && simulation_.config().output.checkpoint_every > 0)) {
    // Without the snapshot of the present moment: the run that goes on from here would not have taken it.
    folder.prepare("checkpoint.h5", [&](const std::string& path) {
      write_checkpoint(path, make_checkpoint(simulation_, *records_));
    });
  }
  folder.prepare_text(result_folder::manifest, json_text(manifest(simulation_, end, message)) + "\n");
  folder.commit();
}

void run_session::save_failure(const std::string& message) {
  if (!folder_) return;
  finish_records();
  // Good results of an earlier run are not given up for those of a failed one.
  if (std::filesystem::exists(folder_->path() / result_folder::manifest)) {
    result_folder beside(folder_->path() / "failed");
    write_results(beside, run_end::failed, message);
    log::warning(fmt::format("the results so far are in '{}' (the folder holds an earlier run)",
                             beside.path().string()));
  } else {
    write_results(*folder_, run_end::failed, message);
  }
}

}  // namespace apsis
