#include <apsis/run/records.hpp>

#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/version.hpp>
#include <apsis/run/body_loads.hpp>
#include <apsis/run/distribution_rows.hpp>
#include <apsis/run/found_walls.hpp>
#include <apsis/run/result_units.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/wall_outlines.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Appends the numbers of a record to a row.
struct row_writer {
  std::vector<double>& row;

  void operator()(const char*, long x) const { row.push_back(static_cast<double>(x)); }
  void operator()(const char*, double x) const { row.push_back(x); }
  void operator()(const char*, const std::vector<double>& x) const {
    row.insert(row.end(), x.begin(), x.end());
  }
};

/// Appends the names of the columns of a record. Columns of a vector are NAME_INVARIANT, NAME_FACE_INVARIANT,
/// cut_MOMENT, lost_force_INVARIANT, or those of torque_columns() and temperature_columns().
struct column_writer {
  const std::vector<std::string>&invariants, &faces, &torques, &walls;
  const std::string cut_moment;
  const bool steady;
  std::vector<std::string>& columns;

  template <class Number>
  void operator()(const char* name, const Number&) const {
    columns.emplace_back(name);
  }
  void operator()(const char* name, const std::vector<double>&) const {
    const std::string head = name;
    if (head == "cut") {
      if (!cut_moment.empty()) columns.push_back("cut_" + cut_moment);
      return;
    }
    if (head == "residual") {
      if (steady) columns.emplace_back("residual_relative");
      return;
    }
    if (head == "torque") {
      columns.insert(columns.end(), torques.begin(), torques.end());
      return;
    }
    if (head == "T_w") {
      columns.insert(columns.end(), walls.begin(), walls.end());
      return;
    }
    if (head == "conservation" || head == "total") return add(head);
    if (head == "lost") {
      const auto force = std::find(faces.begin(), faces.end(), force_balance);
      for (std::size_t k = 1; k < invariants.size() && force != faces.end(); ++k)
        columns.push_back("lost_force_" + invariants[k]);
      return;
    }
    for (const auto& face : faces) add(fmt::format("{}_{}", head, face));
  }
  void add(const std::string& head) const {
    for (const auto& invariant : invariants) columns.push_back(fmt::format("{}_{}", head, invariant));
  }
};

/// Reads the numbers of a record from a row. A vector takes the columns that begin with its name.
class row_reader {
 public:
  row_reader(const std::vector<std::string>& columns, const std::vector<double>& row)
      : columns_(columns), row_(row) {}

  void operator()(const char* name, long& x) { x = static_cast<long>(next(name)); }
  void operator()(const char* name, double& x) { x = next(name); }
  void operator()(const char* name, std::vector<double>& x) {
    const std::string head = std::string(name) + "_";
    x.clear();
    while (at_ < columns_.size() && columns_[at_].rfind(head, 0) == 0) x.push_back(next(columns_[at_]));
  }

 private:
  double next(const std::string& name) {
    if (at_ >= row_.size() || at_ >= columns_.size() || columns_[at_] != name)
      throw io_error(
          fmt::format("the history of the checkpoint has no column '{}' in its place (damaged file); give "
                      "another checkpoint",
                      name));
    return row_[at_++];
  }

  const std::vector<std::string>& columns_;
  const std::vector<double>& row_;
  std::size_t at_ = 0;
};

std::vector<double> to_row(const step_record& record) {
  std::vector<double> row;
  step_record::visit_members(record, row_writer{row});
  return row;
}

step_record from_row(const std::vector<std::string>& columns, const std::vector<double>& row) {
  step_record record;
  row_reader reader(columns, row);
  step_record::visit_members(record, reader);
  return record;
}

[[noreturn]] void refuse_number(const std::string& name) {
  throw io_error("the checkpoint has a wrong number '" + name + "' (damaged file); give another checkpoint");
}

/// Stores numbers in a checkpoint under the names "GROUP.MEMBER".
struct number_writer {
  std::string group;
  checkpoint& to;

  template <class Number>
  void operator()(const char* name, const Number& x) const {
    to.numbers[group + "." + name] = static_cast<double>(x);
  }
};

/// Reads the numbers of number_writer. Counters are stored as doubles, exact up to 2^53. Refuses larger ones,
/// because counters of a damaged file must not overflow.
struct number_reader {
  std::string group;
  const checkpoint& from;

  void operator()(const char* name, double& x) const { x = from.number(group + "." + name); }
  void operator()(const char* name, long& x) const {
    const double number = from.number(group + "." + name);
    if (!(number >= 0.0 && number <= 9007199254740992.0)) refuse_number(group + "." + name);
    x = static_cast<long>(number);
  }
  void operator()(const char* name, bool& x) const { x = from.number(group + "." + name) > 0.0; }
};

std::vector<std::string> history_columns(const simulation& run) {
  const std::vector<std::string> invariants = run.setup().equation->invariants(),
                                 faces = run.setup().open_faces(), torques = torque_columns(run.setup()),
                                 walls = temperature_columns(run.setup());
  std::vector<std::string> columns;
  step_record::visit_members(
      run.initial_record(),
      column_writer{invariants, faces, torques, walls, run.setup().equation->cut_moment(),
                    run.config().steady_state.tolerance.has_value(), columns});
  return columns;
}

std::size_t most_rows(const simulation& run) {
  return static_cast<std::size_t>(run.config().output.history_rows);
}

long stride_of(const checkpoint& c) {
  long stride = 0;
  number_reader{"history", c}("stride", stride);
  if (stride < 1) refuse_number("history.stride");
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
    fields_.dimensions.push_back(all.dimensions[k]);
  }
  if (!run.setup().has_space()) return;
  fields_.axes = mesh_axes(run.mesh());
  for (std::size_t k = 0; k < fields_.axes.size(); ++k)
    fields_.axes[k].periodic = run.setup().periodic(static_cast<int>(k));
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
  run_state saved = run.save();
  checkpoint c;
  c.case_text = to_toml(run.config());
  c.commit = commit();
  c.cells = static_cast<std::uint64_t>(run.mesh().size());
  c.components = static_cast<std::uint64_t>(run.setup().equation->components());
  c.state = std::move(saved.unknowns);
  c.part = part_of(run);
  c.budget = std::move(saved.budget);
  for (kept_value& value : saved.kept)
    c.earlier.push_back({std::move(value.unknowns), std::move(value.budget)});
  run_state::visit_records(saved, [&c](const char* group, const auto& record) {
    record.visit_members(record, number_writer{group, c});
  });
  number_writer{"history", c}("stride", records.history_stride());
  c.history = records.history();
  c.fields = records.fields();
  return c;
}

run_state to_run_state(const checkpoint& c) {
  run_state saved;
  saved.unknowns = c.state;
  saved.budget = c.budget;
  for (const earlier_value& value : c.earlier) saved.kept.push_back({value.state, value.budget});
  if (c.numbers.contains(std::string(steady_group) + ".reference")) saved.steady.emplace();
  if (c.numbers.contains("control.proposed")) saved.control.emplace();  // of a run with a tolerance
  if (c.numbers.contains(std::string(history_group) + ".known")) saved.history.emplace();
  run_state::visit_records(saved, [&c](const char* group, auto& record) {
    record.visit_members(record, number_reader{group, c});
  });
  if (saved.march.startup_steps > 64 || saved.march.startup_done > saved.march.startup_steps)
    throw io_error("the checkpoint has a wrong start-up (damaged file); give another checkpoint");
  saved.initial = from_row(c.history.columns, c.history.rows.front());
  saved.last = from_row(c.history.columns, c.history.rows.back());
  return saved;
}

solution make_solution(const simulation& run, const run_records& records) {
  solution s;
  s.case_text = to_toml(run.config());
  s.title = run.config().title;
  const result_units units(run.config());
  s.t = run.t() * units.factor(units.of_time());
  s.step = run.step();
  s.components = static_cast<std::uint64_t>(run.setup().equation->components());
  const auto& output = run.config().output;
  if (!output.distribution_at.empty()) {
    s.points = rows_at_points(run, units.factor(dimensions::length));
  } else if (output.distribution != distribution_choice::none) {
    s.f = run.state();
    s.part = part_of(run);
  }
  s.velocities = run.setup().equation->velocities();
  s.epsilon = run.epsilon();
  s.fields = units.convert(records.fields());
  s.walls = wall_outlines(run.setup(), units.factor(dimensions::length));
  return s;
}

}  // namespace apsis
