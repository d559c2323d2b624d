#include <apsis/output/checkpoint.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/output/hdf5_file.hpp>
#include <apsis/output/sealed_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

const std::string kind = "checkpoint";

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    parts.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  return parts;
}

// HDF5 has no text datasets of zero bytes; the trailing newline keeps every list nonempty.
std::string joined_lines(const std::vector<std::string>& parts) {
  return fmt::format("{}\n", fmt::join(parts, "\n"));
}

[[noreturn]] void damaged(const std::string& path, const std::string& what) {
  throw io_error(
      fmt::format("'{}' is not a usable checkpoint ({}); give a checkpoint.h5 written by apsis", path, what));
}

void write_rows(hdf5_file& file, const std::string& name, const std::vector<std::vector<double>>& rows,
                std::size_t columns) {
  std::vector<double> all;
  for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
  file.write(name, all, {rows.size(), columns});
}

std::vector<std::vector<double>> read_rows(const hdf5_file& file, const std::string& path,
                                           const std::string& name, std::size_t columns) {
  const auto extents = file.extents(name);
  if (extents.size() != 2 || extents[1] != columns || columns == 0)
    damaged(path, fmt::format("'{}' has a wrong shape", name));
  const std::vector<double> all = file.read(name);
  std::vector<std::vector<double>> rows;
  for (std::size_t at = 0; at < all.size(); at += columns)
    rows.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(at),
                      all.begin() + static_cast<std::ptrdiff_t>(at + columns));
  return rows;
}

/// Writes a state in the shape of the mesh, so that every process can write a box of it.
void write_state(hdf5_file& file, const checkpoint& c, const std::string& name,
                 const std::vector<double>& state) {
  auto extents = c.fields.axes.empty() ? hdf5_file::shape{c.cells} : mesh_shape(c.fields.axes);
  extents.push_back(c.components);
  if (!c.part) return file.write(name, state, extents, "unknowns");
  dataset_part mine = *c.part;
  mine.first.push_back(0);
  mine.count.push_back(c.components);
  file.write_part(name, state, extents, mine, "unknowns");
}

std::vector<double> read_state(const hdf5_file& file, const std::string& path,
                               const std::optional<dataset_part>& part, const std::string& name,
                               checkpoint& c) {
  const auto extents = file.extents(name);
  if (extents.size() < 2 || extents.size() > 4) damaged(path, fmt::format("'{}' has a wrong shape", name));
  c.cells = 1;
  for (std::size_t k = 0; k + 1 < extents.size(); ++k) c.cells *= extents[k];
  c.components = extents.back();
  // A state of another shape is refused by its sizes.
  if (!part || part->first.size() + 1 != extents.size()) return file.read(name);
  dataset_part mine = *part;
  mine.first.push_back(0);
  mine.count.push_back(c.components);
  return file.read_part(name, mine);
}

std::string name_of_earlier(std::size_t k, const char* what) {
  return fmt::format("earlier/{}/{}", k, what);
}

void write_earlier(hdf5_file& file, const checkpoint& c) {
  for (std::size_t k = 0; k < c.earlier.size(); ++k) {
    const earlier_value& value = c.earlier[k];
    write_state(file, c, name_of_earlier(k, "state"), value.state);
    if (!value.budget.empty()) file.write(name_of_earlier(k, "gains"), value.budget, {value.budget.size()});
  }
}

void read_earlier(const hdf5_file& file, const std::string& path, const std::optional<dataset_part>& part,
                  checkpoint& c) {
  for (std::size_t k = 0; file.has(name_of_earlier(k, "state")); ++k) {
    earlier_value value{read_state(file, path, part, name_of_earlier(k, "state"), c), {}};
    if (file.has(name_of_earlier(k, "gains"))) value.budget = file.read(name_of_earlier(k, "gains"));
    c.earlier.push_back(std::move(value));
  }
}

}  // namespace

double checkpoint::number(const std::string& name) const {
  const auto found = numbers.find(name);
  if (found == numbers.end())
    throw io_error(fmt::format(
        "the checkpoint has no number '{}' (written by another version?); run the case again", name));
  return found->second;
}

namespace {

void write_contents(hdf5_file& file, const checkpoint& c) {
  for (const auto& [name, value] : c.numbers) file.write_attribute(name, value);
  file.write("case", c.case_text);
  file.write("commit", c.commit);
  write_state(file, c, "state", c.state);
  if (!c.budget.empty()) file.write("gains", c.budget, {c.budget.size()});
  write_earlier(file, c);
  file.write("history/columns", joined_lines(c.history.columns));
  write_rows(file, "history/rows", c.history.rows, c.history.columns.size());
  file.write("fields/names", joined_lines(c.fields.names));
  file.write("fields/labels", joined_lines(c.fields.labels));
  for (const auto& axis : c.fields.axes)
    file.write("fields/" + axis.name, axis.centres, {axis.centres.size()});
  std::vector<std::vector<double>> snapshots;
  for (const auto& snapshot : c.fields.snapshots) {
    std::vector<double> row = {snapshot.t};
    for (const auto& values : snapshot.values) row.insert(row.end(), values.begin(), values.end());
    snapshots.push_back(std::move(row));
  }
  if (!snapshots.empty())
    write_rows(file, "fields/snapshots", snapshots, 1 + c.fields.names.size() * c.cells);
}

}  // namespace

void write_checkpoint(const std::string& path, const checkpoint& c,
                      const std::shared_ptr<communicator>& processes) {
  write_hdf5(path, seal_length, processes, [&c](hdf5_file& file) { write_contents(file, c); });
  if (!processes) return seal(path, kind);
  run_collectively(*processes, [&] {
    if (processes->is_root()) seal(path, kind);
  });
}

checkpoint read_checkpoint(const std::string& path, const std::optional<dataset_part>& part, bool verify) {
  if (verify) check_seal(path, kind);
  const hdf5_file file = hdf5_file::open(path);
  checkpoint c;
  for (const auto& [name, value] : file.attributes()) c.numbers[name] = value;
  c.case_text = file.read_text("case");
  c.commit = file.read_text("commit");
  read_earlier(file, path, part, c);
  c.state = read_state(file, path, part, "state", c);
  if (file.has("gains")) c.budget = file.read("gains");
  c.history.columns = split(file.read_text("history/columns"));
  c.history.rows = read_rows(file, path, "history/rows", c.history.columns.size());
  if (c.history.rows.empty()) damaged(path, "its history is empty");
  c.fields.names = split(file.read_text("fields/names"));
  c.fields.labels = split(file.read_text("fields/labels"));
  for (const std::string name : {"x", "y", "z"})
    if (file.has("fields/" + name)) c.fields.axes.push_back({name, file.read("fields/" + name)});
  if (!file.has("fields/snapshots")) return c;
  const std::size_t fields = c.fields.names.size();
  for (const auto& row : read_rows(file, path, "fields/snapshots", 1 + fields * c.cells)) {
    field_series::snapshot snapshot;
    snapshot.t = row[0];
    for (std::size_t k = 0; k < fields; ++k)
      snapshot.values.emplace_back(row.begin() + static_cast<std::ptrdiff_t>(1 + k * c.cells),
                                   row.begin() + static_cast<std::ptrdiff_t>(1 + (k + 1) * c.cells));
    c.fields.snapshots.push_back(std::move(snapshot));
  }
  return c;
}

std::string read_case_of_checkpoint(const std::string& path) {
  return hdf5_file::open(path).read_text("case");
}

}  // namespace apsis
