#include <apsis/run/initial_table_file.hpp>

#include <apsis/config/case_json.hpp>
#include <apsis/config/discretization_of_case.hpp>
#include <apsis/config/quantity.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/text_file.hpp>
#include <apsis/output/mesh_axis.hpp>
#include <apsis/output/velocity_axes.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

const std::string none = "dimensionless";

/// Largest number of rows of a table, so that a damaged file cannot exhaust memory.
constexpr std::uint64_t most_table_rows = 1'000'000'000;

/// Datasets of a result that are not columns.
const std::set<std::string> not_columns = {"f", "v", "v_weights", "v_x", "v_y", "v_z", "t"};

/// Returns the member of a JSON object at a path of names; null if it is missing.
nlohmann::ordered_json member_at(const nlohmann::ordered_json& object,
                                 std::initializer_list<const char*> path) {
  const nlohmann::ordered_json* found = &object;
  for (const char* name : path) {
    if (!found->is_object() || !found->contains(name)) return nullptr;
    found = &(*found)[name];
  }
  return *found;
}

/// Returns the numbers of cells of a dataset [cells…][components] as a case has them: a number or a list.
nlohmann::ordered_json cells_as_value(const hdf5_file::shape& extents) {
  if (extents.size() == 2) return extents.front();
  return std::vector<std::uint64_t>(extents.begin(), extents.end() - 1);
}

bool is_hdf5(const std::string& path) {
  return path.ends_with(".h5") || path.ends_with(".hdf5");
}

}  // namespace

initial_table_file::initial_table_file(const case_config& config, const model& equation)
    : config_(config), equation_(equation), path_(config.prescribed.file) {
  if (!is_hdf5(path_) && !path_.ends_with(".csv"))
    refuse("its kind is not known (neither .h5 nor .csv); give for example results/earlier/solution.h5");
  std::error_code ignored;
  if (!std::filesystem::exists(path_, ignored))
    refuse("it does not exist (paths are relative to where the program runs); give an existing file");
  try {
    is_hdf5(path_) ? read_hdf5() : read_csv();
  } catch (const io_error& problem) {
    refuse(problem.what());
  }
  for (const double value : state_)
    if (!std::isfinite(value)) refuse("its state has values that are not finite; give another file");
}

void initial_table_file::refuse(const std::string& problem) const {
  const source_place place = place_of(config_, "initial.file");
  const std::string message = fmt::format("initial.file = '{}' cannot be used: {}", path_, problem);
  if (place.file.empty()) throw input_error(message);
  throw input_error(place, message);
}

std::string initial_table_file::place_of_row(std::size_t row) const {
  return row < lines_.size() ? fmt::format("line {}", lines_[row]) : fmt::format("cell {}", row);
}

/// Takes the manifest of an earlier result. Refuses a model, units or a discretization that
/// the case cannot use.
void initial_table_file::take_manifest(const std::string& text) {
  manifest_ = json::parse(text, nullptr, false);
  const auto name = member_at(manifest_, {"case", "model", "name"});
  if (!name.is_string()) refuse("its manifest cannot be read (damaged file); give another file");
  const model_entry *mine = try_find_model(config_.model.name),
                    *theirs = try_find_model(name.get<std::string>());
  const bool gases = theirs != nullptr && mine->has_velocity_grid && theirs->has_velocity_grid;
  const bool same_variables = member_at(manifest_, {"case", "model", "variables"}) ==
                              member_at(to_json(config_), {"model", "variables"});
  if (!gases && (theirs != mine || !same_variables))
    refuse(fmt::format(
        "it is a result of model '{}'{} (the case has model '{}'); give a result of this model",
        name.get<std::string>(), theirs == mine ? " with other variables" : "", config_.model.name));
  const std::string key = discretization_key;
  const auto discretized = member_at(manifest_, {"case", "space", key.substr(key.find('.') + 1).c_str()});
  if (discretized.is_string()) {
    const auto* entry = try_find_discretization(discretized.get<std::string>());
    if (entry == nullptr)
      refuse(
          fmt::format("it is a result of {} = \"{}\" (this program has no such discretization); give another "
                      "file",
                      key, discretized.get<std::string>()));
    unknown_ = &entry->instance().unknown();
  }
  const auto scales = member_at(manifest_, {"scales"});
  const bool in_si = member_at(manifest_, {"case", "output", "units"}) == choice_name(units_choice::si);
  if (!scales.is_null() && config_.scales && !in_si && scales != to_json(*config_.scales))
    refuse(
        "its units are those of another table [gas] (the scales differ); write it with output.units = "
        "\"SI\", or use the same "
        "reference state");
}

void initial_table_file::read_csv() {
  try {
    column_file table = read_columns(path_);
    columns_ = std::move(table.columns);
    problems_ = std::move(table.problems);
    lines_ = std::move(table.lines);
    for (const auto& [name, values] : columns_) names_.insert(name);
  } catch (const input_error& problem) {
    refuse(problem.what());
  }
  // The manifest beside the table of a result has its units and its mesh.
  const auto manifest = std::filesystem::path(path_).parent_path() / "manifest.json";
  if (std::filesystem::path(path_).filename() == "fields.csv" && std::filesystem::exists(manifest)) {
    constexpr std::size_t longest = 100'000'000;
    take_manifest(read_text_file(manifest.string(), longest, "manifest"));
    const json units = member_at(manifest_, {"units"});
    for (const auto& [name, unit] : units.items())
      if (unit.is_string()) units_[name] = unit.get<std::string>();
  }
  const auto found = columns_.find("t");
  if (found == columns_.end()) {
    if (config_.prescribed.time) refuse("it has no times (no column 't'); remove initial.time");
    return;
  }
  if (const auto problem = problems_.find("t"); problem != problems_.end()) refuse(problem->second);
  std::vector<double> times = found->second;
  times.erase(std::unique(times.begin(), times.end()), times.end());
  const double t = times[chosen(times)];
  std::map<std::string, std::vector<double>> kept;
  std::vector<int> lines;
  const std::vector<double> all = found->second;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k] != t) continue;
    for (const auto& [name, values] : columns_) kept[name].push_back(values[k]);
    lines.push_back(lines_[k]);
  }
  // Only entries at the chosen time matter.
  std::erase_if(problems_, [&kept](const auto& one) {
    const auto& values = kept[one.first];
    return std::none_of(values.begin(), values.end(), [](double x) { return std::isnan(x); });
  });
  columns_ = std::move(kept);
  lines_ = std::move(lines);
}

void initial_table_file::read_hdf5() {
  file_.emplace(hdf5_file::open(path_));
  if (file_->has_attribute("manifest")) take_manifest(file_->read_text_attribute("manifest"));
  if (config_.prescribed.time && manifest_.is_null())
    refuse("it has no times (it is not a result); remove initial.time");
  read_fields(*file_);
}

void initial_table_file::read_fields(const hdf5_file& file) {
  const bool several = !manifest_.is_null() && file.has("snapshots") && file.has("snapshots/t");
  const bool result = !manifest_.is_null();
  std::optional<std::size_t> earlier;  // index of a snapshot before the last
  std::vector<double> times = {result ? file.read_attribute("t") : 0.0};
  if (several) times = file.read("snapshots/t");
  if (times.empty()) refuse("it has no snapshots (damaged file); give another file");
  units_["t"] = several ? file.units("snapshots/t") : units_["t"];
  if (units_["t"].empty() && result && member_at(manifest_, {"units", "t"}).is_string())
    units_["t"] = member_at(manifest_, {"units", "t"}).get<std::string>();
  if (result) {
    const std::size_t k = chosen(times);
    if (k + 1 < times.size()) earlier = k;
  }
  find_columns("", std::nullopt, 0);
  find_columns(earlier ? "snapshots" : "fields", earlier, times.size());
  expand_coordinates(file);
  if (!earlier) return read_state(file);
  read_snapshot_of_state(times[*earlier]);
}

/// Finds the datasets of a group that have a number for each cell. If `snapshot` is given, it selects one of
/// `snapshots`, the first extent of these datasets.
void initial_table_file::find_columns(const std::string& group, std::optional<std::size_t> snapshot,
                                      std::size_t snapshots) {
  for (const auto& name : file_->number_sets(group)) {
    if (not_columns.contains(name)) continue;
    const std::string dataset = group.empty() ? name : fmt::format("{}/{}", group, name);
    const auto shape = file_->extents(dataset);
    if (shape.size() != mesh_rank() + (snapshot ? 1U : 0U)) continue;
    if (snapshot && shape[0] != snapshots)
      refuse(fmt::format("'{}' has {} snapshots of {} (damaged file); give another file", dataset, shape[0],
                         snapshots));
    stored_[name] = {dataset, snapshot};
    names_.insert(name);
  }
}

/// Returns the number of cells that the file claims for a column.
std::uint64_t initial_table_file::rows_of(const std::string& name) const {
  const auto stored = stored_.find(name);
  if (stored == stored_.end()) return columns_.at(name).size();
  const auto shape = file_->extents(stored->second.dataset);
  std::uint64_t rows = 1;
  for (std::size_t k = stored->second.snapshot ? 1 : 0; k < shape.size(); ++k) {
    if (shape[k] > most_table_rows || rows * shape[k] > most_table_rows)
      refuse(fmt::format("'{}' claims more than {} numbers (damaged file); give another file",
                         stored->second.dataset, most_table_rows));
    rows *= shape[k];
  }
  return rows;
}

/// Returns the numbers of a column in the units of the file. Checks its size before reading, because a small
/// file may claim to be large.
std::vector<double> initial_table_file::load(const std::string& name) const {
  if (const auto problem = problems_.find(name); problem != problems_.end()) refuse(problem->second);
  check_rows(name, rows_of(name));
  const auto stored = stored_.find(name);
  std::vector<double> values;
  try {
    if (stored == stored_.end()) {
      values = columns_.at(name);
    } else if (const auto& [dataset, snapshot] = stored->second; !snapshot) {
      values = file_->read(dataset);
    } else {
      dataset_part part{{}, file_->extents(dataset)};
      part.first.assign(part.count.size(), 0);
      part.first.front() = *snapshot;
      part.count.front() = 1;
      values = file_->read_part(dataset, part);
    }
  } catch (const io_error& problem) {
    refuse(problem.what());
  }
  const std::vector<bool> solid = solid_rows(values.size());
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!std::isfinite(values[k]) && !solid[k])
      refuse(fmt::format("'{}' is {} in {} (a finite number is needed); change it", name, values[k],
                         place_of_row(k)));
  return values;
}

/// Refuses a column of wrong size: in several space dimensions it must have a row for each cell of the case,
/// on a line as many rows as x.
void initial_table_file::check_rows(const std::string& name, std::uint64_t rows) const {
  if (mesh_rank() > 1) {
    const auto cells = static_cast<std::uint64_t>(make_mesh(config_).size());
    if (rows != cells) refuse_cells(rows, cells);
  } else if (has_column("x") && (rows != rows_of("x") || rows == 0)) {
    refuse(fmt::format("'{}' has {} numbers and 'x' has {} (each cell has one); give as many", name, rows,
                       rows_of("x")));
  }
}

void initial_table_file::refuse_cells(std::uint64_t rows, std::uint64_t cells) const {
  refuse(
      fmt::format("it has {} cells and the case {} (in several space dimensions data are not "
                  "interpolated); use its space.cells and space.domain",
                  rows, cells));
}

/// Returns the unit that the file gives for a column; empty without one.
std::string initial_table_file::unit_text(const std::string& name) const {
  if (const auto unit = units_.find(name); unit != units_.end()) return unit->second;
  const auto stored = stored_.find(name);
  return stored == stored_.end() ? "" : file_->units(stored->second.dataset);
}

/// Returns the rank of the datasets with a number for each cell.
std::size_t initial_table_file::mesh_rank() const {
  return static_cast<std::size_t>(std::max(equation_.space_dimensions(), 1));
}

/// Expands the coordinates of the axes to a column for each axis, with a row for each cell. Does nothing in
/// one dimension, or if the number of cells is not that of the case.
void initial_table_file::expand_coordinates(const hdf5_file& file) {
  if (mesh_rank() < 2) return;
  const auto cells = static_cast<std::uint64_t>(make_mesh(config_).size());
  std::uint64_t found = 1;
  for (std::size_t k = 0; k < mesh_rank(); ++k) {
    const std::string name(1, "xyz"[k]);
    const auto shape = file.has(name) ? file.extents(name) : hdf5_file::shape{};
    if (shape.size() != 1 || shape[0] > cells) return;
    found *= shape[0];
  }
  if (found != cells) return;
  std::vector<mesh_axis> axes;
  for (std::size_t k = 0; k < mesh_rank(); ++k) {
    const std::string name(1, "xyz"[k]);
    axes.push_back({name, file.read(name)});
    units_[name] = file.units(name);
    names_.insert(name);
  }
  for (std::size_t k = 0; k < axes.size(); ++k) {
    std::vector<double>& column = columns_[axes[k].name];
    for (std::size_t cell = 0; cell < mesh_size(axes); ++cell)
      column.push_back(centre_of_cell(axes, cell, k));
  }
}

std::vector<bool> initial_table_file::solid_rows(std::size_t rows) const {
  std::vector<bool> solid(rows, false);
  if (mesh_rank() < 2 || (config_.solids.empty() && config_.bodies.empty())) return solid;
  const grid mesh = make_mesh(config_);
  for (std::size_t k = 0; k < rows && k < static_cast<std::size_t>(mesh.size()); ++k)
    solid[k] = mesh.solid(static_cast<int>(k)) >= 0;
  return solid;
}

void initial_table_file::check_cells(const grid& mesh, int rows) const {
  if (rows != mesh.size())
    refuse_cells(static_cast<std::uint64_t>(rows), static_cast<std::uint64_t>(mesh.size()));
  constexpr double digits = 1e-2;  // in cell widths, for centres written with few digits
  for (int k = 0; k < mesh.dimensions(); ++k) {
    const std::string name(1, "xyz"[k]);
    if (!has_column(name)) refuse(fmt::format("it has no column '{}' (centres of the cells); add it", name));
    const std::vector<double> centres = column({name}, dimensions::length);
    for (int cell = 0; cell < mesh.size(); ++cell) {
      const double found = centres[static_cast<std::size_t>(cell)], wanted = mesh.centre(cell, k);
      if (std::abs(found - wanted) > digits * mesh.spacing(k))
        refuse(
            fmt::format("{} = {:.10g} in {} (the cell of the case there has {:.10g}; in several space "
                        "dimensions data are not interpolated); use its space.cells and space.domain, "
                        "with x slowest",
                        name, found, place_of_row(static_cast<std::size_t>(cell)), wanted));
    }
  }
}

void initial_table_file::read_state(const hdf5_file& file) {
  if (!file.has("f")) return;
  if (!same_unknowns(file))
    return log::warning(
        fmt::format("initial data: the distribution of '{}' is not used (its velocities or units are "
                    "others); the run begins in equilibrium with its fields",
                    path_));
  const auto shape = file.extents("f");
  std::uint64_t cells = 1;
  for (std::size_t k = 0; k + 1 < shape.size(); ++k) cells *= std::min(shape[k], most_table_rows);
  if (const auto wanted = static_cast<std::uint64_t>(make_mesh(config_).size());
      mesh_rank() > 1 && cells != wanted)
    refuse_cells(cells, wanted);
  if (mesh_rank() == 1 && has_column("x") && rows_of("x") != cells)
    refuse(fmt::format("'x' has {} numbers and the state has {} cells (each cell has one); give as many",
                       rows_of("x"), cells));
  state_ = file.read("f");
}

/// Reads the distribution of an earlier time. It has its own file, if it was written in every cell.
void initial_table_file::read_snapshot_of_state(double t) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(path_).parent_path() / "snapshots";
  const double unit = factor("t", units_["t"], dimensions::time);
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() != ".h5") continue;
    const hdf5_file file = hdf5_file::open(entry.path().string());
    const auto cells = member_at(manifest_, {"case", "space", "cells"});
    const double wanted = t * unit;
    if (std::abs(file.read_attribute("t") - wanted) > 1e-12 * (1.0 + std::abs(wanted)) || !file.has("f") ||
        file.stored("f") != precision::float64)
      continue;
    const auto shape = file.extents("f");
    if (shape.size() != mesh_rank() + 1 || cells != cells_as_value(shape)) continue;
    return read_state(file);
  }
}

bool initial_table_file::same_unknowns(const hdf5_file& file) const {
  const auto shape = file.extents("f");
  if (shape.size() != mesh_rank() + 1 || shape.back() != static_cast<std::uint64_t>(equation_.components()))
    return false;
  const velocity_set& mine = equation_.velocities();
  if (mine.dimensions() > 0) {
    const std::vector<double> points = velocity_points(mine);
    std::uint64_t count = 1;
    for (const auto n : file.has("v") ? file.extents("v") : hdf5_file::shape{0}) count *= n;
    if (count != points.size() || file.read("v") != points) return false;
  }
  if (manifest_.is_null()) return true;
  const auto scales = member_at(manifest_, {"scales"});
  if (!scales.is_null() && config_.scales && scales != to_json(*config_.scales)) return false;
  const char* const kept = "degrees_of_freedom";
  const auto mine_of = config_.model.parameters.find(kept);
  return mine_of == config_.model.parameters.end() ||
         member_at(manifest_, {"case", "model", kept}) == mine_of->second;
}

/// Returns the index of initial.time among `times`, in the units of the file; without it, the last index.
std::size_t initial_table_file::chosen(const std::vector<double>& times) const {
  if (!config_.prescribed.time) return times.size() - 1;
  const auto unit_of_t = units_.find("t");
  const double unit = factor("t", unit_of_t == units_.end() ? "" : unit_of_t->second, dimensions::time);
  const double wanted = *config_.prescribed.time;
  for (std::size_t k = 0; k < times.size(); ++k)
    if (std::abs(times[k] * unit - wanted) <= 1e-9 * (1.0 + std::abs(wanted))) return k;
  std::vector<std::string> known;
  for (const double t : times) known.push_back(fmt::format("{:.10g}", t * unit));
  if (known.size() > 6) {
    known.erase(known.begin() + 3, known.end() - 2);
    known.insert(known.begin() + 3, "...");
  }
  refuse(fmt::format("it has no snapshot at initial.time = {:.10g} (its times are {}); give one of these",
                     wanted, fmt::join(known, ", ")));
}

bool initial_table_file::has_any(const std::vector<std::string>& names) const {
  return std::any_of(names.begin(), names.end(), [this](const auto& name) { return has_column(name); });
}

std::vector<std::string> initial_table_file::columns() const {
  return {names_.begin(), names_.end()};
}

/// Returns the factor that converts a column of the file to units of the case.
double initial_table_file::factor(const std::string& name, const std::string& unit,
                                  const dimension& dims) const {
  if (unit.empty() || unit == none) return 1.0;
  if (!config_.scales)
    refuse(
        fmt::format("'{}' has the unit {} (the case has no table [gas] with the scales of its quantities); "
                    "add the table",
                    name, unit));
  quantity one;
  try {
    one = parse_quantity("1 " + unit, {});
  } catch (const input_error& problem) {
    refuse(fmt::format("the unit of '{}': {}", name, problem.what()));
  }
  if (dims == dimensions::density && one.unit == dimensions::number_density)
    one = {one.value * config_.scales->gas().mass, dimensions::density};
  if (one.unit != dims)
    refuse(fmt::format("'{}' has the unit {} (that of {} is needed); change it", name, unit, unit_of(dims)));
  return one.value / config_.scales->unit(dims);
}

std::vector<double> initial_table_file::column(const std::vector<std::string>& names,
                                               const dimension& dims) const {
  const auto name =
      std::find_if(names.begin(), names.end(), [this](const auto& one) { return has_column(one); });
  std::vector<double> values = load(*name);
  const double by = factor(*name, unit_text(*name), dims);
  if (by != 1.0)
    for (double& value : values) value *= by;
  return values;
}

initial_table_file::line_ends initial_table_file::ends(int cells) const {
  const auto domain = member_at(manifest_, {"case", "space", "domain"});
  if (domain.is_array() && domain.size() == 2 && domain[0].is_number() && domain[1].is_number()) {
    const auto theirs = member_at(manifest_, {"scales", "length", "value"});
    const double unit =
        theirs.is_number() && config_.scales && theirs != config_.scales->unit(dimensions::length)
            ? theirs.get<double>() / config_.scales->unit(dimensions::length)
            : 1.0;
    return {domain[0].get<double>() * unit, domain[1].get<double>() * unit, 1e-9};
  }
  if (!has_column("x")) refuse("it has no column 'x' (centres of the cells); add it");
  const std::vector<double> x = column({"x"}, dimensions::length);
  if (x.size() != static_cast<std::size_t>(cells))
    refuse(fmt::format("'x' has {} numbers and the state has {} cells (each cell has one); give as many",
                       x.size(), cells));
  if (x.size() < 2) refuse("it has one row (the width of a cell is not known from it); give several");
  constexpr double digits = 1e-2;  // in cell widths, for centres written with few digits
  const double width = (x.back() - x.front()) / (cells - 1);
  for (std::size_t k = 1; k < x.size(); ++k) {
    if (!(x[k] > x[k - 1]))
      refuse(fmt::format("x does not increase in {} ({:.10g} after {:.10g}); sort the rows", place_of_row(k),
                         x[k], x[k - 1]));
    if (std::abs(x[k] - (x.front() + static_cast<double>(k) * width)) > digits * width)
      refuse(fmt::format(
          "x is not equidistant in {} ({:.10g}, where equal cells have {:.10g}); interpolate the data "
          "to equal cells",
          place_of_row(k), x[k], x.front() + static_cast<double>(k) * width));
  }
  return {x.front() - 0.5 * width, x.back() + 0.5 * width, digits};
}

}  // namespace apsis
