#pragma once

#include <apsis/config/case.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/output/field_series.hpp>
#include <apsis/run/simulation.hpp>

#include <string>
#include <vector>

namespace apsis {

/// The units of the results of a case (output.units). Quantities of a run are dimensionless; results are
/// converted when they are written.
class result_units {
 public:
  /// Copies the scales and the unit of time of the case.
  explicit result_units(const case_config& config);

  /// Returns whether results are in SI units.
  bool are_si() const { return scales_.has_value(); }
  /// Returns the factor from dimensionless quantities of a dimension to results; 1 if
  /// results are dimensionless.
  double factor(const dimension& dims) const { return scales_ ? scales_->unit(dims) : 1.0; }
  /// Returns the dimension of t: time, or no dimension if t counts iterations to a steady state.
  dimension of_time() const { return of_time_; }
  /// Returns " Pa" with a leading space for reports; "" if there is no unit.
  std::string suffix(const dimension& dims) const;
  /// Returns the suffix with the unit of unit_of_amount().
  std::string suffix_of_amount(const dimension& dims, int lacking) const;

  /// Returns the fields in these units, with the units in their labels.
  field_series convert(field_series fields) const;
  /// Returns a table of a surface in these units.
  surface_table convert(surface_table surface) const;
  /// Returns the history of a run in these units.
  numeric_table convert(numeric_table history, const simulation& run) const;

 private:
  std::optional<gas_scales> scales_;
  dimension of_time_;
};

/// Returns the dimension of the integral of a density over a mesh. The integral is per area on a line, per
/// length in the plane.
dimension dimension_of_integral(dimension density, const grid& mesh);

/// Returns the number of directions in which the domain of a mesh is not extended. Amounts are per area on a
/// line, per length in the plane.
int lacking_directions(const grid& mesh);

/// Dimension and unit of a column of the history of a gas.
struct history_unit {
  std::string column;  ///< name of the column
  dimension dims;      ///< dimension of its numbers
  std::string unit;    ///< SI unit of its numbers
};

/// Returns the columns of the history that have a dimension. These are times, amounts in the domain and
/// through its faces, wall temperatures and loads. Amounts are per area on a line, per length in the plane.
std::vector<history_unit> history_units(const simulation& run);

/// Returns the history of a run for its results: with the columns of with_loads(), in the
/// units of the results.
numeric_table result_history(const numeric_table& history, const simulation& run);

}  // namespace apsis
