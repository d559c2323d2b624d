#pragma once

#include <apsis/boundary/boundary.hpp>
#include <apsis/boundary/domain.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/model.hpp>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// The place in a case that gives a quantity at a face, for messages.
struct quantity_origin {
  source_place place = {};   ///< place of the key
  std::string surface = {};  ///< surface in messages: "[boundary.left]", "body 'disc'"
  int dimensions = 0;        ///< dimensions of space
};

/// A quantity at a face (dimensionless). It is a number or a function of time and the position on the face.
/// It depends on the velocity too if the variable allows this (data_variable::of_velocity).
class face_quantity {
 public:
  /// A function of t and x, which may be called concurrently.
  using function = std::function<double(double t, const position& at)>;
  /// A function of t, x and the velocity v, which may be called concurrently.
  using velocity_function = std::function<double(double t, const position& at, const position& v)>;
  /// Makes the quantity a number.
  face_quantity(double value = 0.0) : number_(value) {}
  /// Makes the quantity a function of t and x.
  face_quantity(function value)
      : function_(
            [of = std::move(value)](double t, const position& at, const position&) { return of(t, at); }) {}
  /// Makes the quantity a function of t, x and v.
  face_quantity(velocity_function value) : function_(std::move(value)) {}

  /// Returns the value at time t at the point x of the face, for the velocity v.
  double at(double t, const position& x, const position& v = {}) const {
    return function_ ? function_(t, x, v) : number_;
  }
  /// Returns true if the quantity is a number.
  bool is_constant() const { return !function_; }
  /// Sets the place of the quantity in a case.
  void set_origin(quantity_origin origin) {
    origin_ = std::make_shared<const quantity_origin>(std::move(origin));
  }
  /// Returns the place of the quantity in a case; null if no case gives it.
  const quantity_origin* origin() const { return origin_.get(); }

 private:
  double number_ = 0.0;
  velocity_function function_;
  std::shared_ptr<const quantity_origin> origin_;
};

/// Components of the variables of a boundary condition by name: "velocity" → {0, 0.1}.
using face_quantities = std::map<std::string, std::vector<face_quantity>>;

/// The model and the values from which a boundary condition is made. The model must outlive the boundary; it
/// is null only for kinds without variables.
struct boundary_source {
  const model* equation = nullptr;         ///< the model on whose components the condition acts
  std::vector<face_quantity> values = {};  ///< values of boundary_entry::variables, by component
  std::vector<std::string> given = {};     ///< names of the variables that a user gave

  /// Returns true if a user gave the variable.
  bool is_given(const std::string& variable) const {
    return std::find(given.begin(), given.end(), variable) != given.end();
  }
};

/// A kind of boundary condition: a file of boundary/kinds/ defines `extern const boundary_entry
/// boundary_<file>`.
struct boundary_entry {
  std::string name;         ///< name in a case file: "periodic"
  std::string description;  ///< one line
  /// Returns the variables of the condition for a model, which are keys of the tables [boundary.left]
  /// and [boundary.right]; null if the condition has none. Throws input_error if the model does not
  /// allow the condition.
  std::vector<data_variable> (*variables)(const model& equation) = nullptr;
  std::unique_ptr<boundary> (*make)(const boundary_source& from) = nullptr;  ///< returns a new object
  bool any_normal = false;  ///< whether boundary::oblique() serves walls with any normal for some models
};

/// Returns all kinds, sorted by file name (generated).
std::vector<const boundary_entry*> boundary_entries();

/// Returns the names of all kinds: "outflow", "periodic", …
std::vector<std::string> boundary_names();

/// Returns the kind called `name`. Throws input_error with the nearest name for others.
const boundary_entry& find_boundary(const std::string& name);
/// Returns a variable of a kind, or nothing if the kind has no such variable. Throws input_error if there is
/// no such kind or the model does not allow it.
std::optional<data_variable> variable_of(const std::string& kind, const model& equation,
                                         const std::string& variable);

/// Returns the boundary of a kind without variables. Throws input_error with the nearest name if there is no
/// such kind, or if it has variables.
std::shared_ptr<const boundary> make_boundary(const std::string& name);

/// Returns the boundary of a kind for a model, with values of its variables. A vector with one value has this
/// value along x and zeros otherwise. `surface` names the boundary in messages about missing values, as in
/// "[boundary.left]". Throws input_error in these cases:
/// - the kind does not exist, or the model does not allow it,
/// - a variable is unknown, missing or of another size,
/// - both a variable and its alternative have values.
std::shared_ptr<const boundary> make_boundary(const std::string& name, const model& equation,
                                              const face_quantities& values = {},
                                              const std::string& surface = "");

/// Returns a domain with the same kind of boundary, without variables, at every face. Throws input_error
/// as make_boundary() does.
domain make_domain(const phase_space& space, const std::string& name);

}  // namespace apsis
