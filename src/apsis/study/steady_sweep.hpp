#pragma once

#include <apsis/output/picture.hpp>
#include <apsis/output/table.hpp>
#include <apsis/study/study_control.hpp>
#include <apsis/study/vary.hpp>

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace apsis {

/// The steady state for one value of the varied key.
struct sweep_row {
  std::string value;              ///< of the key, as on the command line
  bool found = false;             ///< whether the steady state was found
  bool continued = false;         ///< whether the iteration started from the row before
  long iterations = 0;            ///< iterations, of a start that failed too
  double cpu_s = 0.0;             ///< CPU time in seconds
  double residual = 0.0;          ///< relative to that of the start
  double min_value = 0.0;         ///< smallest unknown
  std::vector<double> flux = {};  ///< sweep_table::fluxes; empty unless found
  std::string problem = {};       ///< message where it was not found
};

/// Steady states along a range of values. Dimensionless.
struct sweep_table {
  std::string title;                ///< of the case
  std::string key;                  ///< that varies
  std::vector<std::string> fluxes;  ///< "right_energy": what the gas receives through faces per unit of time
  std::vector<std::string> invariants;  ///< of the model
  std::vector<sweep_row> rows;          ///< in the order of the values
  bool complete = true;                 ///< false after an interruption, with the rows before it
};

/// From "key=values" as parse_vary(), where "a..b" stands for `points` values from a to b, in constant ratios
/// if both have one sign and b/a is at least 4 or at most 1/4, else at constant distances. A key without dot
/// is that of a parameter. Throws input_error as parse_vary().
varied_key parse_sweep(const std::string& text, int points);

/// Finds the steady states of a case for all values of a key, each from that before it, scaled to the mass of
/// its own initial data; from these data where that fails or the sizes differ. Overrides are those of all
/// runs; a case without a table [steady] gets one. Throws input_error for an invalid case, before the first
/// run.
sweep_table run_sweep(const std::string& case_name, const std::vector<std::string>& overrides,
                      const varied_key& varied, const study_control& control = {});

/// Returns the rows with columns KEY, iterations, cpu_s, residual, min_value, flux_FACE_INVARIANT; NaN where
/// no state was found. A text as value is replaced by the number of its row.
numeric_table to_table(const sweep_table& table);
/// Returns the rows as an array of objects.
nlohmann::ordered_json to_json(const sweep_table& table);
/// Returns a panel of fluxes for every invariant that has one, and iterations, over the values; without
/// panels if a value is text.
picture to_picture(const sweep_table& table);
/// Returns the indices of the fluxes above 1e-8 of the largest one.
std::vector<std::size_t> visible_fluxes(const sweep_table& table);

}  // namespace apsis
