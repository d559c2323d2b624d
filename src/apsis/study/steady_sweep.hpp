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
  std::string value;              ///< value of the key, as on the command line
  bool found = false;             ///< whether the steady state was found
  bool continued = false;         ///< whether the iteration started from the row before
  long iterations = 0;            ///< number of iterations, including those of a failed start
  double cpu_s = 0.0;             ///< CPU time in seconds
  double residual = 0.0;          ///< residual relative to that of the start
  double min_value = 0.0;         ///< smallest unknown
  std::vector<double> flux = {};  ///< values of sweep_table::fluxes; empty unless found
  std::string problem = {};       ///< message if it was not found
};

/// Steady states along a range of values. Dimensionless.
struct sweep_table {
  std::string title;                ///< title of the case
  std::string key;                  ///< varied key
  std::vector<std::string> fluxes;  ///< "right_energy": amount that the gas receives there per unit of time
  std::vector<std::string> invariants;  ///< invariants of the model
  std::vector<sweep_row> rows;          ///< in the order of the values
  bool complete = true;                 ///< false after an interruption; the rows are those before it
};

/// Returns the key and the values of "key=values", as parse_vary() does. Here "a..b" stands for `points`
/// values from a to b. They have constant ratios if both ends have one sign and b/a is at least 4 or at
/// most 1/4, otherwise constant distances. A key without dot is that of a parameter. Throws input_error
/// as parse_vary() does.
varied_key parse_sweep(const std::string& text, int points);

/// Finds the steady states of a case for all values of a key. Each starts from the previous one, scaled to
/// the mass of its own initial data. If that fails, or the sizes differ, it starts from its own initial data.
/// Overrides are those of all runs; a case without a table [steady] gets one. Throws input_error for an
/// invalid case, before the first run.
sweep_table run_sweep(const std::string& case_name, const std::vector<std::string>& overrides,
                      const varied_key& varied, const study_control& control = {});

/// Returns the rows with columns KEY, iterations, cpu_s, residual, min_value, flux_FACE_INVARIANT. If no
/// state was found, min_value and the fluxes are NaN. The number of its row replaces a value that is a text.
numeric_table to_table(const sweep_table& table);
/// Returns the rows as an array of objects.
nlohmann::ordered_json to_json(const sweep_table& table);
/// Returns a panel of fluxes over the values for every invariant that has one, and a panel of iterations.
/// There are no panels if a value is a text.
picture to_picture(const sweep_table& table);
/// Returns the indices of the fluxes above 1e-8 of the largest one.
std::vector<std::size_t> visible_fluxes(const sweep_table& table);

}  // namespace apsis
