#include <apsis/run/records.hpp>

#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/version.hpp>

#include <algorithm>

namespace apsis {
namespace {

constexpr std::size_t columns_before_defects = 5, columns_after_defects = 2;

std::vector<double> to_row(const step_record& r) {
  std::vector<double> row = {static_cast<double>(r.step), r.t, r.dt, r.min_value,
                             static_cast<double>(r.negative_values)};
  row.insert(row.end(), r.conservation_defect.begin(), r.conservation_defect.end());
  row.push_back(r.entropy);
  row.push_back(r.entropy_change);
  return row;
}

step_record from_row(const std::vector<double>& row) {
  if (row.size() < columns_before_defects + columns_after_defects)
    throw io_error(
        "the history of the checkpoint has too few columns (damaged file); give another checkpoint");
  step_record r;
  r.step = static_cast<long>(row[0]);
  r.t = row[1];
  r.dt = row[2];
  r.min_value = row[3];
  r.negative_values = static_cast<long>(row[4]);
  r.conservation_defect.assign(row.begin() + columns_before_defects, row.end() - columns_after_defects);
  r.entropy = row[row.size() - 2];
  r.entropy_change = row[row.size() - 1];
  return r;
}

bool has_space(const simulation& run) {
  return has_space(*find_model(run.config().model.name));
}

// Counters travel as doubles, which hold them exactly up to 2^53; a damaged one must not overflow.
long count(const checkpoint& c, const std::string& name) {
  const double x = c.number(name);
  if (!(x >= 0.0 && x <= 9007199254740992.0))
    throw io_error("the checkpoint has a wrong number '" + name +
                   "' (damaged file); give another checkpoint");
  return static_cast<long>(x);
}

std::vector<std::string> history_columns(const simulation& run) {
  std::vector<std::string> columns = {"step", "t", "dt", "min_value", "negative_values"};
  for (const auto& invariant : run.invariants()) columns.push_back("conservation_" + invariant);
  columns.emplace_back("entropy");
  columns.emplace_back("entropy_change");
  return columns;
}

std::size_t most_rows(const simulation& run) {
  return static_cast<std::size_t>(run.config().output.history_rows);
}

long stride_of(const checkpoint& c) {
  const long stride = count(c, "history_stride");
  if (stride < 1)
    throw io_error(
        "the checkpoint has a wrong number 'history_stride' (damaged file); give another checkpoint");
  return stride;
}

}  // namespace

run_records::run_records(const simulation& run) : history_(history_columns(run), most_rows(run)) {
  name_fields(run);
  add_step(run.initial_record());
  if (run.config().output.every > 0.0) add_snapshot(run);
}

run_records::run_records(const simulation& run, const checkpoint& from)
    : history_(from.history, stride_of(from), most_rows(run)) {
  name_fields(run);
  if (from.history.columns != history_columns(run))
    throw io_error(
        "the history of the checkpoint has other columns (written by another version?); run the case again");
  // The choice of fields may have changed; then earlier snapshots cannot be continued.
  if (from.fields.names == fields_.names) fields_.snapshots = from.fields.snapshots;
}

void run_records::name_fields(const simulation& run) {
  const field_table all = run.fields();
  const auto& wanted = run.config().output.fields;
  for (std::size_t k = 0; k < all.names.size(); ++k) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), all.names[k]) == wanted.end()) continue;
    fields_.names.push_back(all.names[k]);
    fields_.labels.push_back(all.labels[k]);
  }
  if (has_space(run)) fields_.x = all.x;
}

void run_records::add_step(const step_record& record) {
  history_.add(to_row(record));
}

void run_records::add_snapshot(const simulation& run) {
  field_table all = run.fields();
  field_series::snapshot snapshot;
  snapshot.t = run.t();
  for (std::size_t k = 0; k < all.names.size(); ++k)
    if (std::find(fields_.names.begin(), fields_.names.end(), all.names[k]) != fields_.names.end())
      snapshot.values.push_back(std::move(all.values[k]));
  fields_.snapshots.push_back(std::move(snapshot));
}

checkpoint make_checkpoint(const simulation& run, const run_records& records) {
  saved_run saved = run.save();
  checkpoint c;
  c.case_text = to_toml(run.config());
  c.commit = commit();
  c.cells = static_cast<std::uint64_t>(run.cells());
  c.components = static_cast<std::uint64_t>(run.components());
  c.state = std::move(saved.state);
  c.numbers = {{"step", static_cast<double>(saved.step)},
               {"since_anchor", static_cast<double>(saved.since_anchor)},
               {"t", saved.t},
               {"anchor", saved.anchor},
               {"anchor_dt", saved.anchor_dt},
               {"startup_steps", static_cast<double>(saved.startup_steps)},
               {"startup_done", static_cast<double>(saved.startup_done)},
               {"startup_length", saved.startup_length},
               {"largest_dt", saved.so_far.dt},
               {"wall_s", saved.so_far.wall_s},
               {"min_value", saved.so_far.min_value},
               {"negative_values", static_cast<double>(saved.so_far.negative_values)},
               {"conservation_defect", saved.so_far.conservation_defect},
               {"max_entropy_increase", saved.so_far.max_entropy_increase},
               {"history_stride", static_cast<double>(records.history_stride())}};
  if (run.config().time.tolerance) {
    c.numbers["proposed_dt"] = saved.proposed_dt;
    c.numbers["previous_error"] = saved.previous_error;
    c.numbers["step_holds"] = saved.step_holds ? 1.0 : 0.0;
    c.numbers["rejected_steps"] = static_cast<double>(saved.so_far.rejected_steps);
  }
  c.history = records.history();
  c.fields = records.fields();
  return c;
}

saved_run to_saved_run(const checkpoint& c) {
  saved_run saved;
  saved.state = c.state;
  saved.step = count(c, "step");
  saved.since_anchor = count(c, "since_anchor");
  saved.t = c.number("t");
  saved.anchor = c.number("anchor");
  saved.anchor_dt = c.number("anchor_dt");
  saved.startup_steps = count(c, "startup_steps");
  saved.startup_done = count(c, "startup_done");
  saved.startup_length = c.number("startup_length");
  if (saved.startup_steps > 64 || saved.startup_done > saved.startup_steps)
    throw io_error("the checkpoint has a wrong start-up (damaged file); give another checkpoint");
  if (c.numbers.count("proposed_dt") > 0) {  // of runs that keep a tolerance
    saved.proposed_dt = c.number("proposed_dt");
    saved.previous_error = c.number("previous_error");
    saved.step_holds = count(c, "step_holds") > 0;
    saved.so_far.rejected_steps = count(c, "rejected_steps");
  }
  saved.so_far.steps = saved.step;
  saved.so_far.t = saved.t;
  saved.so_far.dt = c.number("largest_dt");
  saved.so_far.wall_s = c.number("wall_s");
  saved.so_far.min_value = c.number("min_value");
  saved.so_far.negative_values = count(c, "negative_values");
  saved.so_far.conservation_defect = c.number("conservation_defect");
  saved.so_far.max_entropy_increase = c.number("max_entropy_increase");
  saved.so_far.phase_points = static_cast<long>(c.cells * c.components);
  saved.initial = from_row(c.history.rows.front());
  saved.last = from_row(c.history.rows.back());
  return saved;
}

distribution_snapshot make_distribution_snapshot(const simulation& run, int stride) {
  distribution_snapshot now;
  now.t = run.t();
  now.step = run.step();
  now.components = static_cast<std::uint64_t>(run.components());
  now.velocities = run.velocities();
  const std::vector<double> f = run.state(), x = run.has_space() ? run.fields().x : std::vector<double>();
  for (int cell = 0; cell < run.cells(); cell += stride, ++now.cells) {
    const auto row = f.begin() + static_cast<std::ptrdiff_t>(cell) * run.components();
    now.f.insert(now.f.end(), row, row + run.components());
    if (!x.empty()) now.x.push_back(x[static_cast<std::size_t>(cell)]);
  }
  return now;
}

solution make_solution(const simulation& run, const run_records& records) {
  solution s;
  s.case_text = to_toml(run.config());
  s.title = run.config().title;
  s.t = run.t();
  s.step = run.step();
  s.cells = static_cast<std::uint64_t>(run.cells());
  s.components = static_cast<std::uint64_t>(run.components());
  if (run.config().output.distribution != "none") s.f = run.state();
  s.velocities = run.velocities();
  s.epsilon = run.epsilon();
  s.fields = records.fields();
  return s;
}

}  // namespace apsis
