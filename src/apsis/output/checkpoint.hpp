#pragma once

#include <apsis/output/field_series.hpp>
#include <apsis/output/table.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace apsis {

/// Everything from which a run continues bit for bit as if it had not stopped, including its results so far.
struct checkpoint {
  std::string case_text;                  ///< the resolved case as TOML
  std::string commit;                     ///< commit() of the program that wrote it
  std::uint64_t cells = 0,                ///< rows of the state
      components = 0;                     ///< unknowns of a cell
  std::vector<double> state;              ///< [cells][components]
  std::vector<double> gains;              ///< of the last step at every surface; empty before the first
  std::map<std::string, double> numbers;  ///< time, counters and totals, by name
  numeric_table history;                  ///< from the initial state to the last step
  field_series fields;                    ///< snapshots so far

  /// Returns a number by name. Throws io_error if it is missing.
  double number(const std::string& name) const;
};

/// Writes a sealed HDF5 file (sealed_file.hpp). Throws io_error.
void write_checkpoint(const std::string& path, const checkpoint& c);

/// Reads a checkpoint and checks the shapes of its parts. Throws io_error if the file is missing, damaged,
/// of another version, or not a checkpoint.
checkpoint read_checkpoint(const std::string& path);

}  // namespace apsis
