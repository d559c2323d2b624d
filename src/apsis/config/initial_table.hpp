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
  state_formulas state;      ///< complete
};

/// Part of space with a state of its own, [[initial.region]].
struct initial_region {
  std::string where;                ///< a formula; the region is where it is not 0, "x < 0.5"
  state_formulas state;             ///< replaces variables of the state below
  std::vector<initial_part> parts;  ///< replaces the state below, if there are any
};

/// Table [initial]: a state as formulas of the position, a sum of states, or a file, with regions on top of
/// each other, the last one uppermost. Empty if the case takes data of the model by name.
struct initial_table {
  std::string file;                 ///< result, CSV or HDF5 file, in place of `state`; "" without one
  std::optional<double> time;       ///< of the snapshot in the file (dimensionless); the last one by default
  bool from_python = false;         ///< whether the data are given by the caller of a run
  state_formulas state;             ///< variables outside all regions
  std::vector<initial_part> parts;  ///< terms of a sum, in place of `state`
  std::vector<initial_region> regions;  ///< from the lowest to the uppermost

  /// Whether the table is missing.
  bool empty() const { return !given_elsewhere() && state.empty() && parts.empty() && regions.empty(); }
  /// Whether the state below all regions is not in the case.
  bool given_elsewhere() const { return from_python || !file.empty(); }
};

}  // namespace apsis
