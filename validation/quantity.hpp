#pragma once

#include <apsis/run/simulation.hpp>

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace apsis::validation {

/// A parameter of a quantity, as "name=value" on the command line.
struct quantity_parameter {
  std::string name;   ///< "delta"
  std::string value;  ///< default
  std::string doc;    ///< meaning with unit
};

/// Values of parameters by name.
using quantity_values = std::map<std::string, std::string>;

/// Where a reference value comes from.
enum class origin {
  published,  ///< printed in a paper
  theory,     ///< a formula, or the exact solution of a limit
  computed    ///< computed by an independent solver of the tests
};
/// Returns "published", "theory" or "computed".
std::string to_string(origin from);

/// A value with which the solver is compared.
struct reference_value {
  quantity_values at;       ///< parameters that differ from their defaults
  double value = 0.0;       ///< value as printed
  double tolerance = 1e-3;  ///< relative; allows for the finite number of printed digits
  origin from = origin::published;
};

/// Returns a value from the literature.
inline reference_value published(quantity_values at, double value, double tolerance = 1e-3) {
  return {std::move(at), value, tolerance, origin::published};
}
/// Returns a value with its printed digits, such as "0.6007". The tolerance relative to the value is half a
/// unit of the last digit, plus `accuracy` for the run.
reference_value printed(origin from, quantity_values at, const std::string& digits, double accuracy = 1e-5);
/// Returns a value from a formula or an exact solution.
inline reference_value theory(quantity_values at, double value, double tolerance = 1e-3) {
  return {std::move(at), value, tolerance, origin::theory};
}
/// Returns a value of an independent solver.
inline reference_value computed(quantity_values at, double value, double tolerance = 1e-3) {
  return {std::move(at), value, tolerance, origin::computed};
}

/// Makes and finishes the run of a case with overrides.
using quantity_run = std::function<simulation(const std::string& name, std::vector<std::string> overrides)>;

/// A quantity that one run determines: a file of validation/quantities/ defines `extern const quantity_entry
/// quantity_<file>`.
struct quantity_entry {
  std::string name;                            ///< "couette"
  std::string description;                     ///< one line: the value and its unit
  std::string source;                          ///< source of the reference values
  std::vector<quantity_parameter> parameters;  ///< all parameters, first the number over which values
                                               ///< are drawn
  std::vector<reference_value> references;     ///< may be empty
  /// Returns the value of the quantity. `parameters` has a value for every parameter.
  double (*compute)(const quantity_values& parameters, const quantity_run& run) = nullptr;
};

/// Returns every quantity, sorted by file name (generated).
std::vector<const quantity_entry*> quantity_entries();

/// Returns the quantity with this name. Throws input_error with the nearest name for an unknown one.
const quantity_entry& find_quantity(const std::string& name);

/// Computes a quantity. `settings` are "parameter=value", or "key.of.the.case=value" for the run. `progress`
/// is called with the fraction done and returns whether to stop. Throws input_error for an unknown parameter,
/// quantity_interrupted after a stop, and the errors of a run.
double compute_quantity(const quantity_entry& quantity, const std::vector<std::string>& settings,
                        const std::function<bool(double)>& progress = {});

/// Thrown if `progress` stops a computation.
struct quantity_interrupted {};

/// Returns a parameter as a number > 0. Throws input_error for any other text.
double positive_number(const quantity_values& parameters, const std::string& name);

/// Returns a parameter as a number in [low, high]. Throws input_error for any other text.
double number_between(const quantity_values& parameters, const std::string& name, double low, double high);

/// Returns a parameter that must be one of `words`. Throws input_error with the nearest word for any
/// other text.
const std::string& one_of(const quantity_values& parameters, const std::string& name,
                          const std::vector<std::string>& words);

/// The setting of runs that find a steady state (docs/steady.md).
inline const std::string steady_state = "steady.tolerance=1e-9";

/// Returns the mean over the domain of a smooth function from its values at the cell centres, of fourth
/// order. `shape`: number of cells along x, y, z, at least 3 each; the index of the last direction
/// varies fastest.
double mean_of_cells(std::vector<double> values, const std::vector<int>& shape);

/// Returns the mean of a field over the domain from its values at the cell centres, of fourth order. Throws
/// std::out_of_range for an unknown name.
double mean_of_field(const simulation& run, const std::string& name);

/// Returns a field at the cell centres. Throws std::out_of_range for an unknown name.
std::vector<double> field_values(const simulation& run, const std::string& name);

/// Returns the flux of an invariant into the gas through a face, in the last step of a run. Throws
/// std::out_of_range for unknown names.
double last_flux(const simulation& run, const std::string& face, const std::string& invariant);

/// Returns the columns of the table of a surface by name, such as "area" (compute_surfaces()). Throws
/// std::out_of_range for a surface that is not in output.surfaces.
std::map<std::string, std::vector<double>> wall_values(const simulation& run, const std::string& surface);

}  // namespace apsis::validation
