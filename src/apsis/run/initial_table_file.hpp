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

/// The file `initial.file` of a case at the time `initial.time`: columns of numbers and, in an
/// earlier result, the state. Returned columns have the units of the case. Columns of an HDF5 file
/// are read only on request.
class initial_table_file {
 public:
  /// Reads the file. Throws input_error at the place of the key if the file cannot be used.
  initial_table_file(const case_config& config, const model& equation);

  /// Returns whether the file has the unknowns of the model, on the same velocities.
  bool has_state() const { return !state_.empty(); }
  /// Returns the unknowns, [cells][components].
  std::vector<double> state() const { return state_; }
  /// Returns the kind of unknown that the numbers are: for a result that of its case, for other
  /// files cell averages.
  const cell_unknown& unknown() const { return *unknown_; }

  /// Returns whether the file has a column of one of these names.
  bool has_any(const std::vector<std::string>& names) const;
  /// Returns the first of these columns that the file has, in units of the case. has_any() must be true.
  std::vector<double> column(const std::vector<std::string>& names, const dimension& dims) const;
  /// Returns the names of all columns.
  std::vector<std::string> columns() const;

  /// The line that the cells cover, and the uncertainty of its ends.
  struct line_ends {
    double lower,   ///< lower end
        upper,      ///< upper end
        tolerance;  ///< uncertainty in cell widths
  };
  /// Returns the ends of the domain of a result; for other files those of the cells with the centres `x`.
  /// Refuses centres that are not equidistant.
  line_ends ends(int cells) const;

  /// Returns for each row whether its cell in the case is inside a solid; on a line, false.
  std::vector<bool> solid_rows(std::size_t rows) const;
  /// Checks in several space dimensions that the rows belong to the cells of a mesh. Compares the columns x,
  /// y and z with the centres of the cells. Throws input_error otherwise.
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
  json manifest_;  ///< manifest of an earlier result; null for other files
  const cell_unknown* unknown_ = &cell_averages();
  /// A column of an HDF5 file: its dataset and, if this has several snapshots, the index of one.
  struct stored_column {
    std::string dataset;
    std::optional<std::size_t> snapshot;
  };
  std::optional<hdf5_file> file_;
  std::set<std::string> names_;                  ///< names of all columns
  std::map<std::string, stored_column> stored_;  ///< HDF5 columns, read on request
  std::map<std::string, std::vector<double>> columns_;
  std::map<std::string, std::string> problems_;  ///< messages for columns with entries that are not finite
  std::map<std::string, std::string> units_;
  std::vector<int> lines_;
  std::vector<double> state_;
};

}  // namespace apsis
