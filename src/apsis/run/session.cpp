#include <apsis/run/session.hpp>

#include <apsis/config/case_schema.hpp>
#include <apsis/config/method_of_case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/version.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/exec/global_sum.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/processors.hpp>
#include <apsis/output/json_text.hpp>
#include <apsis/run/distribution_rows.hpp>
#include <apsis/run/memory_need.hpp>
#include <apsis/run/probe_files.hpp>
#include <apsis/run/restart.hpp>
#include <apsis/run/result_units.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/shared_files.hpp>
#include <apsis/run/surface_files.hpp>
#include <apsis/steady/steady_solver.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis {
namespace {

const char* const snapshots = "snapshots";

precision stored_precision(const case_config& config) {
  return config.output.precision == precision_choice::single_precision ? precision::float32
                                                                       : precision::float64;
}

/// Returns the files of f. Their times are in units of the case; `unit_of_time` converts them to those
/// of the other results.
std::vector<distribution_file> distribution_files(const result_folder& folder, double unit_of_time) {
  std::vector<distribution_file> files;
  for (const auto& path : folder.files_of_series(snapshots)) {
    const hdf5_file file = hdf5_file::open(path.string());
    if (!file.has("f") || !file.has("x") || !file.has("v")) continue;  // f of chosen cells, or without axes
    auto extents = file.extents("f");
    extents.pop_back();
    files.push_back({std::string(snapshots) + "/" + path.filename().string(),
                     file.read_attribute("t") * unit_of_time, extents, file.stored("f")});
  }
  return files;
}

constexpr long many_steps = 100'000'000;

/// Logs the keys for a run in time that a case with a table [steady] has and does not use.
void log_unused_times(const case_config& config) {
  if (!config.steady_state.tolerance) return;
  const auto log_unused = [&config](const std::string& what) {
    log::info(fmt::format("{}: {} is not used (the case has a table [steady])", config.source, what));
  };
  if (std::any_of(config.given.begin(), config.given.end(),
                  [](const std::string& key) { return key.starts_with("time."); }))
    log_unused("the table [time]");
  if (config.steady_state.ignores_every) log_unused("output.every, as a time,");
}

/// Returns the setup of a case. Throws input_error unless the state fits into memory, together with its
/// checkpoint and solution.h5 if results are written. Logs the memory that the run needs.
std::unique_ptr<run_setup> setup_with_room_for_results(const case_config& configured,
                                                       const session_options& options) {
  run_collectively(*options.processes, [&] {
    if (options.restart && options.processes->is_root()) check_is_checkpoint(*options.restart);
  });
  const case_config config =
      with_method_of(options.restart, with_chosen_method(configured), *options.processes);
  if (!config.time.method_reason.empty() && !config.steady_state.tolerance)
    log::info(fmt::format("{}: time.method = \"{}\" is {} ({})", config.source, automatic_method,
                          config.time.method, config.time.method_reason));
  log_unused_times(config);
  std::unique_ptr<run_setup> setup;
  run_collectively(*options.processes, [&] {
    setup = std::make_unique<run_setup>(config, options.processes, options.on);
    const int copies = options.out ? 2 : 0;
    check_memory(*setup, copies);
    check_device_memory(*setup);
    log::info(fmt::format("{}: needs {}", config.source, memory_need(*setup, copies).text()));
  });
  return setup;
}

/// Returns a text of everything on which the collective operations of a run depend.
std::string description_of(const case_config& config, const session_options& options) {
  return fmt::format("{}results = {}\nrestart = \"{}\"\ninitial data = {}\n", to_toml(config),
                     options.out ? "given" : "not given", options.restart.value_or(""),
                     options.initial ? "given" : "not given");
}

/// Refuses different cases: processes would mix them, or wait for each other forever.
const case_config& same_on_all(const case_config& mine, const session_options& options) {
  communicator& processes = *options.processes;
  if (processes.is_single()) return mine;
  std::string first;
  run_collectively(processes, [&] { first = description_of(mine, options); });
  const std::string own = first;
  broadcast_text(processes, first);
  run_collectively(processes, [&] {
    const auto [there, here] = first_difference(first, own);
    if (first != own)
      throw input_error(
          fmt::format("process {} was given another case than process 0 ('{}' instead of '{}'); give all "
                      "processes the same",
                      processes.rank(), here, there));
  });
  return mine;
}

/// Returns the source of the initial state. A restart takes data that are not in the case
/// from the checkpoint.
state_source start_of(const case_config& config, const session_options& options) {
  if (!options.restart) return options.initial;
  return config.prescribed.given_elsewhere() ? state_of_checkpoint(*options.restart) : state_source{};
}

/// Returns a time of the case, and in seconds if results are in SI units: "14.36, or 0.0125 s".
std::string time_text(double t, const case_config& config) {
  const result_units units(config);
  if (!units.are_si()) return fmt::format("{}", t);
  return fmt::format("{}, or {:.6g}{}", t, t * units.factor(dimensions::time),
                     units.suffix(dimensions::time));
}

std::string duration(double seconds) {
  if (seconds < 7200.0) return fmt::format("{:.0f} minutes", seconds / 60.0);
  if (seconds < 172800.0) return fmt::format("{:.0f} hours", seconds / 3600.0);
  return fmt::format("{:.3g} days", seconds / 86400.0);
}

}  // namespace

int threads_for(const case_config& config, const communicator& processes) {
  if (const int requested = requested_threads(); requested > 0) return requested;
  constexpr double large = 32768.0;
  const double unknowns = 1.0 * make_model(config)->components() * make_mesh(config).size();
  if (unknowns < large * processes.size()) return 1;
  return std::min(available_processors(processes.processes_here()), most_threads);
}

run_session::run_session(const case_config& configured, session_options options)
    : options_(std::move(options)),
      simulation_(setup_with_room_for_results(same_on_all(configured, options_), options_),
                  start_of(configured, options_)) {
  // The folder is locked first: no checkpoint may be read from a folder into which another run writes.
  run_collectively(processes(), [this] {
    if (options_.out && processes().is_root()) folder_ = std::make_unique<result_folder>(*options_.out);
  });
  if (options_.restart)
    resume(*options_.restart);
  else
    records_ = std::make_unique<run_records>(simulation_);
  const case_config& config = simulation_.config();
  snapshots_ = simulation_.snapshot_times_passed();
  if (has_folder() && options_.restart)
    resume_snapshots(*options_.restart);
  else if (simulation_.step() == 0 && config.output.every > 0.0)
    write_distribution_snapshot();
  if (const auto& output = config.output;
      !has_folder() && !(output.probes.empty() && output.slices.empty() && output.surfaces.empty()))
    log::warning("no probes, slices and surfaces are written (they need a folder); give one with --out");
  if (!has_folder() && config.output.checkpoint_every > 0)
    log::warning("no checkpoints are written (output.checkpoint_every needs a folder); give one with --out");
  if (config.output.distribution == distribution_choice::snapshots &&
      !(has_folder() && config.output.every > 0.0))
    log::warning(
        "no snapshots of f are written (output.distribution = \"snapshots\" needs output.every and a "
        "folder); "
        "give both");
  const long steps = simulation_.steps_total();
  const int ranks = processes().size();
  const std::string work = config.steady_state.tolerance
                               ? fmt::format("at most {} iterations to the steady state", steps)
                               : fmt::format("about {} steps of {}", steps, config.time.method);
  const std::string promised =
      config.steady_state.tolerance ? promise_of_steady_state() : simulation_.promises().text();
  log::info(fmt::format("{}: {} on {}{} thread{}; {}", config.source, work,
                        ranks == 1 ? "" : fmt::format("{} processes of ", ranks), threads(),
                        threads() == 1 ? "" : "s", promised));
  if (steps - simulation_.step() >= many_steps) warn_at_step_ = simulation_.step() + 1000;
}

std::string run_session::promise_of_steady_state() const {
  const run_setup& setup = simulation_.setup();
  const relaxation_model* relaxes = setup.equation->as_relaxation();
  if (relaxes != nullptr && is_nonnegative(*relaxes, setup.builder()))
    return "of the steady state f >= 0 is promised, of iterates nothing";
  const std::string why = setup.builder().keeps_sign() ? setup.equation->why_signed() : "";
  return "nothing is promised" + (why.empty() ? "" : "; " + why);
}

void run_session::resume(const std::string& path) {
  const checkpoint saved = read_by_all(path, processes(), part_of(simulation_));
  check_checkpoint(saved, path, simulation_);
  const run_state state = to_run_state(saved);
  if (!(state.march.t < simulation_.config().time.end) && simulation_.config().steady_state.tolerance)
    throw input_error(fmt::format("'{}' is already after {} iterations (steady.iterations is {}); give more",
                                  path, state.march.t, simulation_.config().steady_state.iterations));
  if (!(state.march.t < simulation_.config().time.end))
    throw input_error(fmt::format("'{}' is already at t = {} (time.end is {}); give a later time.end", path,
                                  time_text(state.march.t, simulation_.config()),
                                  time_text(simulation_.config().time.end, simulation_.config())));
  simulation_.restore(state);
  records_ = std::make_unique<run_records>(simulation_, saved);
}

run_end run_session::run() {
  try {
    loop();
  } catch (const numerical_error& failure) {
    if (options_.stepped) options_.stepped();
    if (simulation_.may_continue()) records_->add_step(simulation_.last());
    save_failure(failure.what());
    throw;
  }
  if (options_.stepped) options_.stepped();
  finish_records();
  if (has_folder())
    write_results(folder_.get(), end_, "");
  else if (end_ != run_end::complete)
    log::warning("nothing was saved (a checkpoint needs a folder); give one with --out");
  return end_;
}

void run_session::finish_records() {
  shown_ = std::make_unique<run_records>(*records_);
  const auto steady = simulation_.config().time.steady;
  if (steady && simulation_.last().change <= *steady) {
    const result_units units(simulation_.config());
    const double time = units.factor(dimensions::time);
    log::info(
        fmt::format("time.steady = {:g} is reached at t = {:g}{}: {}", *steady / time, simulation_.t() * time,
                    units.suffix(dimensions::time),
                    to_text(estimate_steady_state(shown_->history()), time, units.suffix(dimensions::time))));
  }
  if (simulation_.config().steady_state.tolerance && simulation_.finished()) report_steady_state();
  const auto& taken = shown_->fields().snapshots;
  if (taken.empty() || taken.back().t != simulation_.t()) shown_->add_snapshot(simulation_);
}

void run_session::report_steady_state() const {
  const step_record& last = simulation_.last();
  log::info(
      fmt::format("the steady state is found after {} iterations: residual {:.2g}, change of the moments "
                  "{:.2g}",
                  simulation_.step(), last.residual.front(), last.change));
  const model& equation = *simulation_.setup().equation;
  if (last.negative_values == 0 || !equation.positive()) return;
  log::info(fmt::format(
      "{} values of f are below 0; space.limiter = \"positivity\"{} keeps them at 0 or above",
      last.negative_values, equation.why_signed().empty() ? "" : " with model.tails = \"nonnegative\""));
}

void run_session::take_snapshot() {
  records_->add_snapshot(simulation_);
  write_distribution_snapshot();
}

void run_session::write_distribution_snapshot() {
  const auto& output = simulation_.config().output;
  if (!has_folder() || output.distribution != distribution_choice::snapshots) return;
  const distribution_snapshot now = make_distribution_snapshot(simulation_);
  write_by_all(
      processes(),
      [&](const file_writer& write) {
        folder_->add_to_series(snapshots, fmt::format("f-{:09}.h5", now.step), write);
      },
      [&](const std::string& path) {
        write_distribution(path, now, stored_precision(simulation_.config()), options_.processes);
      });
}

/// Resumes the series with the snapshots taken before the checkpoint.
void run_session::resume_snapshots(const std::string& checkpoint) {
  if (simulation_.config().output.distribution != distribution_choice::snapshots) return;
  run_collectively(processes(), [&] {
    if (!folder_) return;
    folder_->resume_series(snapshots, std::filesystem::path(checkpoint).parent_path(),
                           [this](const std::string& path) {
                             return hdf5_file::open(path).read_attribute("t") <= simulation_.t();
                           });
  });
}

void run_session::loop() {
  if (options_.watch) options_.watch(simulation_);
  while (!simulation_.finished()) {
    if (end_ = end_requested(); end_ != run_end::complete) return;
    if (has_folder() && !before_end_ && simulation_.next_step_depends_on_end())
      before_end_ = make_checkpoint(simulation_, *records_);
    simulation_.advance();
    after_step();
  }
}

/// Returns interrupted if a process was asked to stop, wall_time if the wall time of the root is over, and
/// otherwise complete.
run_end run_session::end_requested() const {
  const bool late = options_.wall && processes().is_root() &&
                    std::chrono::duration<double>(clock::now() - start_).count() >= *options_.wall;
  std::array<std::int64_t, 2> wanted = {options_.stop && options_.stop() ? 1 : 0, late ? 1 : 0};
  processes().sum(wanted);
  if (wanted[0] > 0) return run_end::interrupted;
  return wanted[1] > 0 ? run_end::wall_time : run_end::complete;
}

void run_session::warn_of_many_steps() {
  const double left = static_cast<double>(simulation_.steps_total() - simulation_.step());
  const run_summary done = simulation_.summary();
  const double seconds = done.wall_s / static_cast<double>(done.steps);
  log::warning(fmt::format(
      "about {:.2g} steps are left (the next one is {:.3g} long, time.end = {:g}): {} at {:.2g} s a "
      "step; choose longer steps, or end the run with --wall",
      left, simulation_.dt(), simulation_.config().time.end, duration(left * seconds), seconds));
}

void run_session::after_step() {
  const step_record& last = simulation_.last();
  records_->add_step(last);
  const long passed = simulation_.snapshot_times_passed();
  if (passed > snapshots_) take_snapshot();
  snapshots_ = passed;
  if (last.step == warn_at_step_) warn_of_many_steps();
  if (checkpoint_is_due()) publish_checkpoint();
  if (options_.watch) options_.watch(simulation_);
}

bool run_session::checkpoint_is_due() const {
  if (!has_folder()) return false;
  const auto& output = simulation_.config().output;
  if (output.checkpoint_every > 0 && simulation_.step() % output.checkpoint_every == 0) return true;
  if (!(output.checkpoint_minutes > 0.0)) return false;
  // The clock of the root decides.
  const std::chrono::duration<double, std::ratio<60>> since = clock::now() - last_checkpoint_;
  return global_count(processes(),
                      processes().is_root() && since.count() >= output.checkpoint_minutes ? 1 : 0) > 0;
}

void run_session::publish_checkpoint() {
  const checkpoint now = make_checkpoint(simulation_, *records_);
  write_by_all(
      processes(), [&](const file_writer& write) { folder_->publish("checkpoint.h5", write); },
      [&](const std::string& path) { write_checkpoint(path, now, options_.processes); });
  last_checkpoint_ = clock::now();
}

/// Only the root has a `folder`.
void run_session::write_results(result_folder* folder, run_end end, const std::string& message) {
  std::string about =
      json_text(manifest(simulation_, {end, message, started_, options_.command, options_.restart,
                                       estimate_steady_state(shown_->history()), warnings_.messages()})) +
      "\n";
  broadcast_text(processes(), about);
  solution final_state = make_solution(simulation_, *shown_);
  final_state.manifest = about;
  const std::vector<surface_table> walls = simulation_.surfaces();
  run_collectively(processes(), [&] {
    if (folder != nullptr) write_tables(*folder, final_state, walls);
  });
  const auto by_all = [&](const char* name, const file_writer& write) {
    write_by_all(processes(), [&](const file_writer& all) { folder->prepare(name, all); }, write);
  };
  by_all("solution.h5",
         [&](const std::string& path) { write_solution(path, final_state, options_.processes); });
  if (end != run_end::failed || simulation_.may_continue()) {
    // The checkpoint omits the extra snapshot of the current time, which the continued run
    // would not have taken.
    if (end_ != run_end::complete || !before_end_) before_end_ = make_checkpoint(simulation_, *records_);
    by_all("checkpoint.h5",
           [&](const std::string& path) { write_checkpoint(path, *before_end_, options_.processes); });
  }
  run_collectively(processes(), [&] {
    if (folder == nullptr) return;
    folder->prepare_text(result_folder::manifest, about);
    folder->commit();
  });
}

void run_session::write_tables(result_folder& folder, const solution& final_state,
                               const std::vector<surface_table>& walls) {
  const result_units units(simulation_.config());
  folder.prepare_text("history.csv",
                      to_csv(result_history(shown_->history(), simulation_), {"step", "negative_values"}));
  folder.prepare_text("fields.csv", to_csv(to_table(final_state.fields)));
  write_probes(simulation_.config(), final_state.fields, units.factor(dimensions::length), folder);
  write_surfaces(walls, simulation_.config(), folder);
  folder.prepare_text("solution.xdmf",
                      solution_xdmf(final_state, distribution_files(folder, units.factor(units.of_time()))));
}

void run_session::save_failure(const std::string& message) {
  if (!has_folder()) return;
  finish_records();
  // Results of a failed run do not replace those of an earlier successful run.
  std::unique_ptr<result_folder> beside;
  bool earlier = false;
  run_collectively(processes(), [&] {
    if (!folder_ || !std::filesystem::exists(folder_->path() / result_folder::manifest)) return;
    earlier = true;
    if (const auto failed = folder_->path() / "failed"; std::filesystem::is_symlink(failed))
      std::filesystem::remove(failed);  // nothing is written through a link
    beside = std::make_unique<result_folder>(folder_->path() / "failed");
    if (simulation_.config().output.distribution == distribution_choice::snapshots)
      beside->resume_series(snapshots, folder_->path(), [](const std::string&) { return true; });
  });
  write_results(beside ? beside.get() : folder_.get(), run_end::failed, message);
  if (earlier)
    log::warning(fmt::format("the results so far are in '{}' (the folder holds an earlier run)",
                             beside->path().string()));
}

}  // namespace apsis
