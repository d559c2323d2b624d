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

/// A value of an earlier time, like the state.
struct earlier_value {
  std::vector<double> state,  ///< [cells][components], or those of the part of this process
      budget;                 ///< at every surface; may be empty
};

/// Everything from which a run continues bit for bit as if it had not stopped, including its results so far.
struct checkpoint {
  std::string case_text;                  ///< the resolved case as TOML
  std::string commit;                     ///< commit() of the program that wrote it
  std::uint64_t cells = 0,                ///< rows of the state
      components = 0;                     ///< unknowns of a cell
  std::vector<double> state;              ///< [cells][components], or those of the part of this process
  std::vector<double> budget;             ///< of the last step at every surface; empty before the first
  std::vector<earlier_value> earlier;     ///< that later steps need
  std::map<std::string, double> numbers;  ///< time, counters and totals, by name
  numeric_table history;                  ///< from the initial state to the last step
  field_series fields;                    ///< snapshots so far
  std::optional<dataset_part> part = {};  ///< of the mesh, of one of several processes

  /// Returns a number by name. Throws io_error if it is missing.
  double number(const std::string& name) const;
};

/// Writes a sealed HDF5 file (sealed_file.hpp). Throws io_error. `processes`: those that write the file
/// together, each with its part; everything else is the same on all, but snapshots, which are those of the
/// root.
void write_checkpoint(const std::string& path, const checkpoint& c,
                      const std::shared_ptr<communicator>& processes = nullptr);

/// Reads a checkpoint and checks the shapes of its parts. Throws io_error if the file is missing, damaged,
/// of another version, or not a checkpoint. `part`: the part of the mesh whose state is read, by default all
/// of it; a file that was written by any number of processes is read by any other. `verify`: whether the
/// checksum is computed, which reads the whole file.
checkpoint read_checkpoint(const std::string& path, const std::optional<dataset_part>& part = std::nullopt,
                           bool verify = true);

/// Returns checkpoint::case_text alone, unverified. Throws io_error if the file cannot be read.
std::string read_case_of_checkpoint(const std::string& path);

}  // namespace apsis
