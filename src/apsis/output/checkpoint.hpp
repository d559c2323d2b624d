#pragma once

#include <apsis/output/field_series.hpp>
#include <apsis/output/hdf5_file.hpp>
#include <apsis/output/table.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// A value of an earlier time, stored like the state.
struct earlier_value {
  std::vector<double> state,  ///< [cells][components], or those of the part of this process
      budget;                 ///< boundary budget at every surface; may be empty
};

/// All data from which a run continues bit for bit as if it had not stopped, including its results so far.
struct checkpoint {
  std::string case_text;       ///< the resolved case as TOML
  std::string commit;          ///< commit() of the program that wrote it
  std::uint64_t cells = 0,     ///< rows of the state
      components = 0;          ///< unknowns of a cell
  std::vector<double> state;   ///< [cells][components], or those of the part of this process
  std::vector<double> budget;  ///< boundary budget of the last step at every surface; empty before the first
  std::vector<earlier_value> earlier;     ///< earlier values that later steps need
  std::map<std::string, double> numbers;  ///< time, counters and totals, by name
  numeric_table history;                  ///< from the initial state to the last step
  field_series fields;                    ///< snapshots so far
  std::optional<dataset_part> part = {};  ///< part of the mesh of this process, if several share it

  /// Returns a number by name. Throws io_error if it is missing.
  double number(const std::string& name) const;
};

/// Writes a sealed HDF5 file (sealed_file.hpp). Throws io_error. `processes` write the file together, each
/// with its part. Everything else is the same on all, except snapshots, which are those of the root.
void write_checkpoint(const std::string& path, const checkpoint& c,
                      const std::shared_ptr<communicator>& processes = nullptr);

/// Reads a checkpoint and checks the shapes of its parts. Throws io_error if the file is missing, damaged, of
/// another version, or not a checkpoint. `part` is the part of the mesh whose state is read, by default all
/// of it. The number of processes need not be that of the run that wrote the file. `verify`: whether to
/// compute the checksum, which reads the whole file.
checkpoint read_checkpoint(const std::string& path, const std::optional<dataset_part>& part = std::nullopt,
                           bool verify = true);

/// Returns checkpoint::case_text alone, unverified. Throws io_error if the file cannot be read.
std::string read_case_of_checkpoint(const std::string& path);

}  // namespace apsis
