#pragma once

#include <apsis/boundary/boundary.hpp>
#include <apsis/boundary/wall_temperature.hpp>
#include <apsis/config/reference_values.hpp>
#include <apsis/mesh/face.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/model/gas_model.hpp>
#include <apsis/run/surface_table.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// Returns the indices of the momenta among the invariants of a model, one for each velocity dimension.
/// Returns an empty list if the model lacks one of them.
std::vector<std::size_t> places_of_momenta(const model& equation);

/// Returns the index of a name; nothing if it is missing.
std::optional<std::size_t> place_of_name(const std::vector<std::string>& names, const std::string& name);

/// The columns of a surface that are derived from the fluxes of the invariants: pressure, shear stress, heat
/// flux, and with reference values their coefficients.
class load_columns {
 public:
  load_columns(const model& equation, const std::optional<reference_values>& reference);

  /// Adds the names and dimensions of the columns. `fluxes` are the dimensions of the
  /// fluxes of the invariants.
  void add_names(surface_table& table, const std::vector<dimension>& fluxes) const;
  /// Appends the values at a piece of wall with the normal n into the gas, from the fluxes `given` of the
  /// invariants. In the plane the shear stress is the component counter-clockwise around the body.
  void add_values(std::vector<double>& row, const std::vector<double>& given, const std::array<double, 3>& n,
                  const std::array<double, 3>& wall_velocity) const;
  /// Appends the values at a face of a cell. In the plane the shear stress is the component along the axis.
  void add_values(std::vector<double>& row, const std::vector<double>& given, const face& where,
                  const std::array<double, 3>& wall_velocity) const;

 private:
  void add(std::vector<double>& row, double pressure, std::optional<double> shear,
           std::optional<double> heat) const;

  std::vector<std::size_t> momenta_;   ///< indices of the momenta; empty if the model lacks one
  std::optional<std::size_t> energy_;  ///< index of the energy; nothing without momenta
  const std::optional<reference_values>& reference_;
};

/// The columns of the state of a gas; other models have no such columns.
class gas_columns {
 public:
  explicit gas_columns(const model& equation) : gas_(equation.as_gas()) {}

  void add_names(surface_table& table) const;
  /// Appends the values that follow from `moments`, the densities of the invariants; NaN if they are
  /// unknown or not admissible.
  void add_values(std::vector<double>& row, std::span<const double> moments) const;

 private:
  int directions() const { return gas_->molecules().dimensions(); }

  const gas_model* gas_;
};

/// The columns of the one-way fluxes of mass and energy to and from a surface, if the model
/// has these invariants.
class one_way_columns {
 public:
  explicit one_way_columns(const model& equation);

  void add_names(surface_table& table, const std::vector<dimension>& fluxes) const;
  /// Appends the values; NaN for unknown fluxes.
  void add_values(std::vector<double>& row, std::span<const double> arriving,
                  std::span<const double> leaving) const;

 private:
  struct amount {
    std::string name;
    std::size_t invariant;
  };
  std::vector<amount> amounts_;
};

/// The column of the temperature of a wall; only for surfaces whose boundary has one.
class wall_temperature_column {
 public:
  /// `equation` must outlive the object.
  explicit wall_temperature_column(const model& equation);

  /// Adds the name for a boundary.
  void add_name(surface_table& table, const boundary* side) const;
  /// Appends the value at a point where the fluxes `arriving` of the invariants arrive. It is NaN where these
  /// are not known, or where the temperature has no effect.
  void add_value(std::vector<double>& row, const boundary* side, const wall_point& where,
                 std::span<const double> arriving) const;

  /// Returns the value that add_value() appends. Returns nothing where that is NaN, and for a boundary
  /// without a temperature.
  std::optional<double> value(const boundary* side, const wall_point& where,
                              std::span<const double> arriving) const;

 private:
  const wall_temperature* of(const boundary* side) const;

  const model& equation_;
  std::optional<std::size_t> mass_, energy_;
  std::vector<std::size_t> momenta_;
};

/// Sorts the rows of a surface by their first column.
void sort_by_first_column(surface_table& table);

/// Orders the rows of a body in the plane along its wall, with the body on the left. The rows must be
/// sorted by angles. Replaces the angles by the length along the wall to the middle of each piece. An open
/// wall begins at its opening, a closed one with its first row. The length between two walls is the
/// distance of their ends.
void measure_around(surface_table& table, const grid& mesh);

}  // namespace apsis
