#pragma once

#include <apsis/config/initial_table.hpp>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace apsis {

/// Stands for every surface in output.surfaces.
inline constexpr const char* all_surfaces = "all";

/// Names of the balances of terms that are not surfaces.
inline constexpr const char* force_balance = "force";        ///< of the force
inline constexpr const char* rotation_balance = "rotation";  ///< of axisymmetric flow
inline constexpr const char* source_balance = "source";      ///< of the sources
/// All of them. No solid box or body can have one of these names.
inline constexpr std::array<const char*, 3> balance_terms = {force_balance, rotation_balance, source_balance};

/// A table [boundary.left], [boundary.right], …: the boundary condition of a face.
struct face_table {
  std::optional<std::string> kind;  ///< if not set, space.boundary applies
  state_formulas values;            ///< variables of the kind: formulas in t and the position
  bool operator==(const face_table&) const = default;  ///< equal texts
};

/// A table [[space.solid]]: a solid box and its wall.
struct solid_table {
  std::string name;              ///< in the history of the amounts that its walls receive
  std::vector<double> from;      ///< lower corner, on edges of cells
  std::vector<double> to;        ///< upper corner, on edges of cells
  std::string kind = "diffuse";  ///< boundary condition at its faces
  state_formulas values;         ///< variables of the kind: formulas in t and the position
  bool operator==(const solid_table&) const = default;  ///< equal texts
};

/// A shape of a body: its kind, and the values of its keys.
struct shape_table {
  /// A number, a vector, points, or a text or formula.
  using value = std::variant<double, std::vector<double>, std::vector<std::vector<double>>, std::string>;

  std::string shape;                                      ///< kind: "circle"
  std::map<std::string, value> values;                    ///< by key
  std::map<std::string, std::vector<shape_table>> parts;  ///< shapes that it combines, by key
  bool operator==(const shape_table&) const = default;    ///< equal values
};

/// A table [[space.body]]: a body of any shape and its wall.
struct body_table {
  std::string name;              ///< in the history of the amounts that its wall receives
  shape_table shape;             ///< shape and position
  std::string kind = "diffuse";  ///< boundary condition at its wall
  state_formulas values;         ///< variables of the kind: formulas in t and the position
  bool operator==(const body_table&) const = default;  ///< equal texts
};

}  // namespace apsis
