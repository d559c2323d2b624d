#pragma once

#include <apsis/model/dimension.hpp>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// A variable that prescribes initial data, such as a density or a bulk velocity.
struct data_variable {
  std::string name;                  ///< key of the table [initial], "rho"
  std::string doc;                   ///< meaning with unit
  int size = 1;                      ///< number of components of a vector
  std::optional<double> value = {};  ///< default of every component; the variable is required without it
  apsis::dimension dimension = {};   ///< gives its unit for a gas (gas_scales.hpp)
  /// Whether it also depends on the velocity. Its values at all velocities are then contiguous.
  bool of_velocity = false;
  /// Name of a variable that may replace this one, or "". Neither has a default then.
  std::string alternative = {};
  /// Whether it is an integral over a whole surface. Its dimension is then `dimension` times that of an area,
  /// and its value depends on t alone.
  bool over_surface = false;
};

/// Sources S(t, x, u) of a model in which a row follows from its variables.
struct source_of_state {
  /// values ← the variables of the row u.
  std::function<void(std::span<const double> u, std::span<double> values)> variables;
  /// row ← E'(values) rates: the change per unit of time of an equilibrium whose variables change at `rates`.
  std::function<void(std::span<const double> values, std::span<const double> rates, std::span<double> row)>
      row;
};

/// One way to prescribe a row, for example as a Maxwellian by density, velocity and temperature.
struct data_form {
  std::string description;               ///< "Maxwellian"
  std::vector<data_variable> variables;  ///< in the order of `values` below, vectors by component
  /// u ← the row with these values of the variables. Returns "", or the reason why no such row exists:
  /// "density -1 is not positive".
  std::function<std::string(std::span<const double> values, std::span<double> u)> row;
  std::optional<source_of_state> source = {};  ///< empty if sources cannot depend on the variables
};

}  // namespace apsis
