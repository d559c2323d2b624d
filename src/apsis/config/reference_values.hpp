#pragma once

#include <apsis/model/dimension.hpp>

#include <string>
#include <vector>

namespace apsis {

/// A table [output.reference]: the stream and the size to which coefficients of bodies and walls refer.
/// Dimensionless.
struct reference_values {
  double density = 0.0,          ///< ρ of the stream
      temperature = 0.0,         ///< T of the stream
      length = 0.0,              ///< reference length of torques; in the plane also of forces
      area = 0.0;                ///< reference area of forces in space; 0 in the plane
  std::vector<double> velocity,  ///< U of the stream, a component for each direction of space
      centre,                    ///< point about which torques are taken; default: the origin
      up;                        ///< in space: lift is the force along its part across U; empty: no lift
  bool about_axis = false;       ///< axisymmetric flow: forces refer to an area, no lift
  /// Returns whether all values are equal.
  bool operator==(const reference_values&) const = default;

  double speed() const;                                       ///< |U|
  double dynamic_pressure() const;                            ///< ρU²/2
  double size() const { return area > 0.0 ? area : length; }  ///< of forces: length in the plane, else area
  /// Returns the unit vector across U along which a force is lift. In the plane it is U turned by 90°
  /// counter-clockwise, in space the part of `up` across U. Empty in space without `up`, and about an axis.
  std::vector<double> lift_direction() const;
};

/// A key of the table [output.reference].
struct reference_key {
  const char* name;                                ///< "density"
  apsis::dimension dimension;                      ///< with a table [gas], values may have units of it
  double reference_values::* number;               ///< member with the number; null for a vector
  std::vector<double> reference_values::* vector;  ///< member with the vector; null for a number
  bool positive;                                   ///< whether it must be > 0
  bool required;                                   ///< whether every case needs it
  int only_in;      ///< number of space dimensions that have it; 0: two and three
  bool about_axis;  ///< whether axisymmetric flow has it
  const char* doc;  ///< meaning
};

/// Returns the keys in the order in which they are written.
const std::vector<reference_key>& reference_keys();

}  // namespace apsis
