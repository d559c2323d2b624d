#pragma once

#include <apsis/body/shape.hpp>
#include <apsis/velocity/position.hpp>

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace apsis {

/// A function φ of the position. It must be thread-safe.
using level_set_function = std::function<double(const position&)>;

/// Shapes that another shape combines.
using shape_list = std::vector<std::shared_ptr<const shape>>;

/// A value of a key of a shape. The alternatives have the order of shape_value_kind.
using shape_value = std::variant<double, std::vector<double>, std::vector<std::vector<double>>, std::string,
                                 level_set_function, shape_list>;

/// Values of keys of a shape by name: "radius" → 0.5.
using shape_values = std::map<std::string, shape_value>;

/// The type of the value of a key.
enum class shape_value_kind {
  number,   ///< a finite number
  vector,   ///< a list of finite numbers
  points,   ///< a list of vectors
  text,     ///< a text, such as the path of a file
  formula,  ///< a function of the position
  shapes    ///< a list of shapes
};

/// A key of a shape.
struct shape_key {
  std::string name;                                  ///< name in a case file: "radius"
  std::string doc;                                   ///< meaning of the value, without an article
  shape_value_kind kind = shape_value_kind::number;  ///< type of its value
  std::optional<shape_value> value = {};             ///< default; a key without a default is required
  bool positive = false;                             ///< whether its numbers must be positive
  std::size_t components = 0;  ///< of a vector or point; 0 stands for the dimensions of the mesh
  std::size_t fewest = 0;      ///< least number of points or shapes
  std::size_t most = 0;        ///< largest number of points or shapes; 0 stands for no limit
  bool is_length = true;       ///< whether its numbers are lengths; others have no unit
  bool planar = false;         ///< whether its shapes lie in the plane (x, y), in a body of 3 dimensions
};

/// Checked values of all keys from which a shape is made.
class shape_arguments {
 public:
  /// `values` must have a value for every key of the shape `name`.
  shape_arguments(std::string name, shape_values values, int dimensions)
      : name_(std::move(name)), values_(std::move(values)), dimensions_(dimensions) {}

  int dimensions() const { return dimensions_; }                     ///< 2 or 3
  double number(const std::string& key) const;                       ///< returns a number
  const std::vector<double>& numbers(const std::string& key) const;  ///< returns all numbers of a vector
  position vector(const std::string& key) const;                     ///< returns a vector, filled with 0
  /// Returns a vector divided by its length. Throws input_error for the vector 0.
  position direction(const std::string& key) const;
  std::vector<position> points(const std::string& key) const;       ///< returns points, filled with 0
  const std::string& text(const std::string& key) const;            ///< returns a text
  const level_set_function& formula(const std::string& key) const;  ///< returns a function
  const shape_list& shapes(const std::string& key) const;           ///< returns the shapes of a list
  /// Throws input_error "'`key`' of shape '…' `problem`; `suggestion`".
  [[noreturn]] void refuse(const std::string& key, const std::string& problem,
                           const std::string& suggestion) const;

 private:
  std::string name_;
  shape_values values_;
  int dimensions_;
};

/// Returns the values of all keys, given or by default. Throws input_error with the nearest name for an
/// unknown key, and for a missing one. Throws input_error for a value of another kind or size, and for a
/// number that is not finite. Magnitudes are at most 1e100; numbers that must be positive are at least
/// 1e-100.
shape_arguments check_shape_values(const std::string& name, const std::vector<shape_key>& keys,
                                   const shape_values& given, int dimensions);

}  // namespace apsis
