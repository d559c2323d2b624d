#pragma once

#include <apsis/output/field_series.hpp>
#include <apsis/output/table.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace apsis {

/// Everything that a run needs to go on as if it had never stopped, bit for bit, its results so far included.
struct checkpoint {
  std::string case_text;                  ///< the resolved case as TOML
  std::string commit;                     ///< commit() of the program that wrote it
  std::uint64_t cells = 0,                ///< rows of the state
      components = 0;                     ///< unknowns of a cell
  std::vector<double> state;              ///< [cells][components]
  std::map<std::string, double> numbers;  ///< time, counters and totals, by name
  numeric_table history;                  ///< from the initial state to the last step
  field_series fields;                    ///< snapshots so far

  /// A number that must be there. Throws io_error.
  double number(const std::string& name) const;
};

/// A sealed HDF5 file (sealed_file.hpp). Throws io_error.
void write_checkpoint(const std::string& path, const checkpoint& c);

/// Reads and checks that all parts fit together. Throws io_error: missing, damaged, of another version, or no
/// checkpoint.
checkpoint read_checkpoint(const std::string& path);

}  // namespace apsis
