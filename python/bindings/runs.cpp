#include "arrays.hpp"
#include "given_data.hpp"
#include "library_call.hpp"

#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/first_error.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/version.hpp>
#include <apsis/device/find_device.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/processes.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/output/probe.hpp>
#include <apsis/output/velocity_axes.hpp>
#include <apsis/run/result_units.hpp>
#include <apsis/run/session.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/wall_outlines.hpp>

#include <atomic>
#include <chrono>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>
#include <pybind11/stl.h>

namespace apsis::python {
namespace {

/// How far a run is: step, steps in all (estimated), t, smallest value. False ends it.
using progress_function = std::optional<py::function>;

/// Whether an answer is False of Python or NumPy; anything else, including None, continues the run.
bool is_false(const py::object& answer) {
  const auto type = std::string(py::str(py::type::of(answer).attr("__name__")));
  return (type == "bool" || type == "bool_") && !answer.cast<bool>();
}

/// Asks Python from time to time whether to continue: pending signals, and the function of the user.
class attendant {
 public:
  explicit attendant(progress_function progress) : progress_(std::move(progress)) {}

  void watch(const simulation& run) {
    const auto now = std::chrono::steady_clock::now();
    if (now - asked_ < std::chrono::milliseconds(50) && !run.finished()) return;
    asked_ = now;
    const py::gil_scoped_acquire python;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!progress_) return;
    const py::object answer = (*progress_)(run.step(), run.steps_total(), run.t(), run.last().min_value);
    stopped_ = stopped_ || is_false(answer);
  }
  bool stopped() const { return stopped_; }
  void stop() { stopped_ = true; }

 private:
  progress_function progress_;
  std::chrono::steady_clock::time_point asked_;
  bool stopped_ = false;
};

py::dict columns_of(const numeric_table& rows) {
  py::dict columns;
  for (std::size_t k = 0; k < rows.columns.size(); ++k) {
    std::vector<double> column;
    for (const auto& row : rows.rows) column.push_back(row[k]);
    columns[py::str(rows.columns[k])] = to_array(std::move(column));
  }
  return columns;
}

py::dict columns_of(const surface_table& surface) {
  py::dict columns;
  columns["face"] = py::module_::import("numpy").attr("array")(surface.faces, "str");
  columns.attr("update")(columns_of(surface.numbers));
  return columns;
}

/// Returns the shape of an array with numbers before and after those of the mesh: [first…][nx][ny][last…].
std::vector<py::ssize_t> shape_of(const std::vector<mesh_axis>& axes, std::vector<py::ssize_t> first,
                                  const std::vector<py::ssize_t>& last = {}) {
  for (const auto n : mesh_shape(axes)) first.push_back(static_cast<py::ssize_t>(n));
  first.insert(first.end(), last.begin(), last.end());
  return first;
}

/// Walls of the bodies: [pieces][corners][dimensions].
py::dict walls_of(const simulation& run, double unit_of_length) {
  py::dict walls;
  for (const wall_outline& wall : wall_outlines(run.setup(), unit_of_length)) {
    const auto size = wall.shape();
    walls[py::str(wall.name)] = to_array(wall.array(), {size.begin(), size.end()});
  }
  return walls;
}

/// Snapshots of every field: [snapshots][nx][ny].
py::dict fields_of(const field_series& series) {
  py::dict fields;
  for (std::size_t k = 0; k < series.names.size(); ++k) {
    std::vector<double> all;
    for (const auto& one : series.snapshots)
      all.insert(all.end(), one.values[k].begin(), one.values[k].end());
    fields[py::str(series.names[k])] =
        to_array(std::move(all), shape_of(series.axes, {static_cast<py::ssize_t>(series.snapshots.size())}));
  }
  return fields;
}

/// Velocities as in solution.h5, with weights, axes and marginals of f where there are several dimensions.
void add_velocities(const simulation& run, const std::vector<mesh_axis>& mesh, const std::vector<double>& f,
                    py::dict& out) {
  const velocity_set& velocities = run.setup().equation->velocities();
  py::dict axes, marginal_values;
  if (velocities.dimensions() < 2) {
    out["v"] = to_array(velocity_points(velocities));
    out["v_weights"] = to_array(std::vector<double>());
  } else {
    out["v"] = to_array(velocity_points(velocities), {velocities.size(), velocities.dimensions()});
    const auto weights = velocities.weights();
    out["v_weights"] = to_array(std::vector<double>(weights.begin(), weights.end()));
    for (auto& axis : velocity_axes(velocities)) axes[py::str(axis.name)] = to_array(std::move(axis.nodes));
    for (auto& one : marginals(f, static_cast<std::uint64_t>(run.mesh().size()), velocities))
      marginal_values[py::str(one.axis.name)] = to_array(
          std::move(one.values), shape_of(mesh, {}, {static_cast<py::ssize_t>(one.axis.nodes.size())}));
  }
  out["axes"] = axes;
  out["marginals"] = marginal_values;
}

/// Messages of a run are those of the root.
class silence_of_others {
 public:
  explicit silence_of_others(const communicator& processes) : silenced_(!processes.is_root()) {
    if (silenced_) before_ = log::set_level(log::level::quiet);
  }
  ~silence_of_others() {
    if (silenced_) log::set_level(before_);
  }
  silence_of_others(const silence_of_others&) = delete;
  silence_of_others& operator=(const silence_of_others&) = delete;

 private:
  bool silenced_;
  log::level before_ = log::level::warning;
};

/// The right to call processes together, of one thread at a time: two that do so in another order on each
/// process would wait for each other for ever.
class turn_of_processes {
 public:
  explicit turn_of_processes(bool needed) : held_(needed) {
    if (held_ && taken_.exchange(true))
      throw input_error(
          "comm cannot be used (another thread of this process has a run with processes); wait for its end");
  }
  ~turn_of_processes() {
    if (held_) taken_ = false;
  }
  turn_of_processes(const turn_of_processes&) = delete;
  turn_of_processes& operator=(const turn_of_processes&) = delete;

 private:
  static inline std::atomic<bool> taken_ = false;
  bool held_;
};

/// Collective; complete on the root.
py::dict result_of(const run_session& session, run_end end) {
  const simulation& run = session.computed();
  py::dict out;
  out["state"] = to_string(end);
  out["json"] = to_json(run, session.records(), session.warnings()).dump();
  std::vector<double> f = run.whole_state();
  std::vector<double> epsilon = run.epsilon();
  const result_units units(run.config());
  const field_series fields = units.convert(session.records().fields());
  add_velocities(run, fields.axes, f, out);
  const std::vector<surface_table> walls = run.surfaces();
  if (!run.processes().is_root()) return {};
  out["f"] = to_array(std::move(f), shape_of(fields.axes, {}, {run.setup().equation->components()}));
  for (const std::string name : {"x", "y", "z"}) out[py::str(name)] = to_array(std::vector<double>());
  for (const auto& axis : fields.axes) out[py::str(axis.name)] = to_array(std::vector<double>(axis.centres));
  out["epsilon"] = epsilon.empty() ? to_array(std::move(epsilon))
                                   : to_array(std::move(epsilon), shape_of(fields.axes, {}));
  out["history"] = columns_of(result_history(session.records().history(), run));
  std::vector<double> times;
  for (const auto& one : fields.snapshots) times.push_back(one.t);
  out["t"] = to_array(std::move(times));
  py::dict labels;
  for (std::size_t k = 0; k < fields.names.size(); ++k) labels[py::str(fields.names[k])] = fields.labels[k];
  out["labels"] = labels;
  out["fields"] = fields_of(fields);
  py::dict probes;
  for (line_probe line : run.config().output.probes) {
    line.scale(units.factor(dimensions::length));
    probes[py::str(line.name)] = columns_of(to_table(fields, line));
  }
  out["probes"] = probes;
  py::dict surfaces;
  for (const surface_table& surface : walls)
    surfaces[py::str(surface.name)] = columns_of(units.convert(surface));
  out["surfaces"] = surfaces;
  out["walls"] = walls_of(run, units.factor(dimensions::length));
  return out;
}

/// Processes that do not respond for so many seconds get no error; they do not call apsis.run.
constexpr double patience = 60.0;

py::object run_on(const std::shared_ptr<communicator>& processes, const std::optional<std::string>& text,
                  const std::string& name, const std::vector<std::string>& overrides,
                  const std::optional<std::string>& out, const std::optional<std::string>& restart,
                  std::optional<double> wall, std::optional<int> threads,
                  const std::optional<std::string>& device, const progress_function& progress,
                  const py::object& initial, const std::vector<double>& jumps) {
  const silence_of_others quiet(*processes);
  case_config config;
  run_collectively(*processes,
                   [&] { config = text ? parse_case(*text, name, overrides) : load_case(name, overrides); });
  const library_call own(threads.value_or(threads_for(config, *processes)));
  attendant asks(progress);
  session_options how;
  how.processes = processes;
  run_collectively(*processes, [&] {
    if (device) how.on = open_device(*device, processes->number_here());
  });
  how.out = out;
  how.restart = restart;
  how.wall = wall;
  first_error failure;
  how.watch = [&](const simulation& run) {
    // The run ends with a checkpoint, on all processes at the same step, before the exception leaves.
    failure.run([&] { asks.watch(run); });
    if (failure) asks.stop();
  };
  how.stop = [&asks] { return asks.stopped(); };
  if (!initial.is_none())
    how.initial = [&initial, &jumps](const run_setup& setup) {
      field state;
      run_collectively(setup.processes(), [&] {
        const py::gil_scoped_acquire python;
        state = make_state(initial, *setup.equation, setup.builder(), jumps, "initial");
      });
      return setup.checked(std::move(state));
    };
  std::unique_ptr<run_session> session;
  run_end end{};
  {
    const py::gil_scoped_release others;
    {
      const interruptible before_steps(raise_pending_signals);
      session = std::make_unique<run_session>(std::move(config), how);
    }
    end = session->run();
  }
  agree_on_errors(*processes, failure.take());
  py::dict result = result_of(*session, end);
  return processes->is_root() ? py::object(std::move(result)) : py::object(py::none());
}

py::object run_case(const std::optional<std::string>& text, const std::string& name,
                    const std::vector<std::string>& overrides, const std::optional<std::string>& out,
                    const std::optional<std::string>& restart, std::optional<double> wall,
                    std::optional<int> threads, const std::optional<std::string>& device,
                    const progress_function& progress, const py::object& initial,
                    const std::vector<double>& jumps, std::optional<int> communicator_handle) {
  const turn_of_processes turn(communicator_handle.has_value());
  const auto processes = communicator_handle ? processes_of(*communicator_handle) : single_process();
  std::exception_ptr failure;
  py::object result;
  try {
    result = run_on(processes, text, name, overrides, out, restart, wall, threads, device, progress, initial,
                    jumps);
  } catch (...) {
    failure = std::current_exception();
  }
  processes->end_together(failure, failure ? patience : std::numeric_limits<double>::infinity());
  if (failure) std::rethrow_exception(failure);
  return result;
}

/// Throws on the other processes of a communicator, which are in run_case(), that this one refuses to run.
void refuse_on_all(int communicator_handle, const std::string& message) {
  processes_of(communicator_handle)->end_together(std::make_exception_ptr(input_error(message)), patience);
}

}  // namespace

void bind_runs(py::module_& m) {
  m.def("run", &run_case);
  m.def("refuse_on_all", &refuse_on_all);
  m.def("case_names", &case_names);
  m.def("read_case", &read_case);
  m.def("model_names", [] {
    std::vector<std::string> names;
    for (const auto* entry : model_entries()) names.push_back(entry->name);
    return names;
  });
  m.def("version", &version);
}

}  // namespace apsis::python
