#pragma once

#include <apsis/config/case.hpp>
#include <apsis/model/model.hpp>
#include <apsis/output/column_file.hpp>
#include <apsis/output/hdf5_file.hpp>
#include <apsis/semidiscrete/cell_unknown.hpp>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace apsis {

/// The file `initial.file` of a case at the time `initial.time`: columns of numbers and, of an earlier
/// result, the state. All numbers are converted to the units of the case. Columns that nobody asks for, and
/// other content of an HDF5 file, are not read.
class initial_table_file {
 public:
  /// Reads the file. Throws input_error at the place of the key.
  initial_table_file(const case_config& config, const model& equation);

  /// Whether the file has the unknowns of the model, on the same velocities.
  bool has_state() const { return !state_.empty(); }
  /// Returns the unknowns, [cells][components].
  std::vector<double> state() const { return state_; }
  /// Returns what the numbers are: those of a result as in its case, others cell averages.
  const cell_unknown& unknown() const { return *unknown_; }

  /// Whether the file has a column of one of these names.
  bool has_any(const std::vector<std::string>& names) const;
  /// Returns the first of these columns, in units of the case.
  std::vector<double> column(const std::vector<std::string>& names, const dimension& dims) const;
  /// Returns the names of all columns.
  std::vector<std::string> columns() const;

  /// The line that the cells cover, and the uncertainty of its ends.
  struct line_ends {
    double lower,   ///< lower end
        upper,      ///< upper end
        tolerance;  ///< in cell widths
  };
  /// Returns the ends: those of the domain of a result, or from the centres `x`, which must be equidistant.
  line_ends ends(int cells) const;

  /// Whether each of the rows is that of a cell of the case inside a solid, in several space dimensions.
  std::vector<bool> solid_rows(std::size_t rows) const;
  /// Checks in several space dimensions that the rows are those of the cells of a mesh, by the columns x, y
  /// and z of their centres.
  void check_cells(const grid& mesh, int rows) const;

  /// Returns "line 7" or "cell 5", for messages.
  std::string place_of_row(std::size_t row) const;
  /// Throws input_error with the place of the key and "initial.file = 'FILE' cannot be used: problem".
  [[noreturn]] void refuse(const std::string& problem) const;

 private:
  using json = nlohmann::ordered_json;
  void read_csv();
  void read_hdf5();
  void read_state(const hdf5_file& file);
  void read_fields(const hdf5_file& file);
  void read_snapshot_of_state(double t);
  void expand_coordinates(const hdf5_file& file);
  std::size_t mesh_rank() const;
  void find_columns(const std::string& group, std::optional<std::size_t> snapshot, std::size_t snapshots);
  bool has_column(const std::string& name) const { return names_.contains(name); }
  std::uint64_t rows_of(const std::string& name) const;
  std::vector<double> load(const std::string& name) const;
  [[noreturn]] void refuse_cells(std::uint64_t rows, std::uint64_t cells) const;
  void check_rows(const std::string& name, std::uint64_t rows) const;
  std::string unit_text(const std::string& name) const;
  void take_manifest(const std::string& text);
  bool same_unknowns(const hdf5_file& file) const;
  std::size_t chosen(const std::vector<double>& times) const;
  double factor(const std::string& name, const std::string& unit, const dimension& dims) const;

  const case_config& config_;
  const model& equation_;
  std::string path_;
  json manifest_;  ///< of an earlier result; null for other files
  const cell_unknown* unknown_ = &cell_averages();
  /// A column of an HDF5 file: its dataset, and which snapshot of one with several.
  struct stored_column {
    std::string dataset;
    std::optional<std::size_t> snapshot;
  };
  std::optional<hdf5_file> file_;
  std::set<std::string> names_;                  ///< of the columns
  std::map<std::string, stored_column> stored_;  ///< those that are read when they are asked for
  std::map<std::string, std::vector<double>> columns_;
  std::map<std::string, std::string> problems_;  ///< of columns with entries that are not finite numbers
  std::map<std::string, std::string> units_;
  std::vector<int> lines_;
  std::vector<double> state_;
};

}  // namespace apsis
