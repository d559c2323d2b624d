#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// Formulas of the variables of a state by name, one for each component: "u" → {"0.1", "0"}.
using state_formulas = std::map<std::string, std::vector<std::string>>;

/// A term of a sum of states, [[initial.part]].
struct initial_part {
  std::string weight = "1";  ///< factor, a formula of the position
  state_formulas state;      ///< a complete state
};

/// Part of space with its own state, [[initial.region]].
struct initial_region {
  std::string where;                ///< formula such as "x < 0.5"; the region is where it is not 0
  state_formulas state;             ///< replaces variables of the state below
  std::vector<initial_part> parts;  ///< replaces the state below, if there are any
};

/// Table [initial]: a state as formulas of the position, a sum of states, or a file. Regions lie above it,
/// the last one uppermost. The table is empty if the case takes data of the model by name.
struct initial_table {
  std::string file;                     ///< result, CSV or HDF5 file, in place of `state`; "" without one
  std::optional<double> time;           ///< of the snapshot in the file, dimensionless; default: the last one
  bool from_python = false;             ///< whether the caller of a run gives the data
  state_formulas state;                 ///< variables outside all regions
  std::vector<initial_part> parts;      ///< terms of a sum, in place of `state`
  std::vector<initial_region> regions;  ///< from the lowest to the uppermost

  /// Returns whether the table is missing.
  bool empty() const { return !given_elsewhere() && state.empty() && parts.empty() && regions.empty(); }
  /// Returns whether the state below all regions is not in the case.
  bool given_elsewhere() const { return from_python || !file.empty(); }
};

}  // namespace apsis
