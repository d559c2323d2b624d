#pragma once

#include <apsis/body/shape.hpp>
#include <apsis/body/shape_value.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// A kind of shape: a file of body/shapes/ defines `extern const shape_entry shape_<file>`.
struct shape_entry {
  std::string name;                      ///< name in a case file: "sphere"
  std::string description;               ///< one line
  std::vector<shape_key> keys;           ///< keys of this kind, without those of all shapes
  std::vector<int> dimensions = {2, 3};  ///< supported numbers of dimensions
  std::string alternative = {};          ///< advice for other numbers of dimensions: "use 'circle'"
  /// Returns a new shape. Throws input_error for values that contradict each other, and io_error for a file
  /// that cannot be read.
  std::shared_ptr<const shape> (*make)(const shape_arguments& from) = nullptr;
};

/// Returns all kinds, sorted by file name (generated).
std::vector<const shape_entry*> shape_entries();

/// Returns the names of all kinds: "box", "circle", …
std::vector<std::string> shape_names();

/// Returns the kind called `name`. Throws input_error with the nearest name for an unknown one.
const shape_entry& find_shape(const std::string& name);

/// Returns the keys that every shape accepts in d = 2 or 3 dimensions: `shift`, a vector, and `rotate`. The
/// latter is an angle in degrees about the origin for d = 2; for d = 3 it is an axis through the origin,
/// followed by the angle.
std::vector<shape_key> common_shape_keys(int dimensions);

/// Returns the shape of a kind in d = 2 or 3 dimensions, first rotated about the origin, then shifted. Throws
/// input_error for an unknown kind, or for an unsupported number of dimensions. Also throws the errors of
/// check_shape_values() and shape_entry::make.
std::shared_ptr<const shape> make_shape(const std::string& name, const shape_values& values, int dimensions);

}  // namespace apsis
