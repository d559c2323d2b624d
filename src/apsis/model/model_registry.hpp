#pragma once

#include <apsis/model/expression.hpp>
#include <apsis/model/model.hpp>
#include <apsis/velocity/velocity_config.hpp>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// A numeric parameter of a model, a key of [model].
struct model_parameter {
  std::string name;      ///< key in the table [model]
  double value;          ///< default
  double lowest;         ///< smallest allowed value
  double highest;        ///< largest allowed value
  std::string doc;       ///< description with unit
  bool integer = false;  ///< whether only integers are allowed
  /// Whether a case may set it to "auto", which is then the default. model::automatic_value() computes an
  /// automatic value from the initial data. `value` applies to models without data.
  bool automatic = false;
  bool of_space = false;  ///< 0 stands for the number of space dimensions and is replaced by it
};

/// A string option of a model: one of several names, or a formula.
struct model_option {
  std::string name;                  ///< key in the table [model]
  std::string value;                 ///< default
  std::vector<std::string> choices;  ///< predefined names
  std::string variable;              ///< variable of a formula with any finite values; "": names only
  std::string doc;                   ///< description
};

/// A list option of a model: names that the case chooses, or formulas.
struct model_list {
  std::string name;                ///< key in the table [model]
  std::vector<std::string> value;  ///< default
  std::string variables;           ///< earlier list that names the variables of formulas; "": names
  std::string doc;                 ///< description
  /// Whether an entry is a list of numbers or of constant formulas. It is stored as a text such as "1, 0".
  bool tuples = false;
};

/// Configuration of a model.
struct model_config {
  std::map<std::string, double> parameters;                    ///< complete: defaults filled in
  std::map<std::string, std::string> options;                  ///< complete; each a choice or a valid formula
  velocity_config velocity;                                    ///< only for entries with has_velocity_grid
  formula_constants constants = {};                            ///< constants of formulas
  std::map<std::string, std::vector<std::string>> lists = {};  ///< complete; each a valid name or formula
  int space_dimensions = 1;                              ///< D, for models that exist in several dimensions
  bool operator==(const model_config&) const = default;  ///< equal values
};

/// One equation of the registry: a file of model/models/ defines `extern const model_entry model_<file>`.
struct model_entry {
  std::string name;                              ///< name in a case file (model.name)
  std::string description;                       ///< one line with the equation
  std::string source;                            ///< citation
  bool has_velocity_grid = false;                ///< whether it needs the table [velocity]
  std::vector<model_parameter> parameters = {};  ///< in the order in which they are documented
  std::vector<model_option> options = {};        ///< in the order in which they are documented
  std::vector<model_list> lists = {};            ///< in the order in which they are documented
  /// Returns the model. Throws input_error if the velocity grid or a formula is invalid.
  std::unique_ptr<model> (*make)(const model_config&) = nullptr;
};

/// Returns the model with default_config(), for queries. It is constructed once per process. Thread-safe.
const model& prototype(const model_entry& entry);

/// Whether the model needs the table [space].
inline bool has_space(const model_entry& entry) {
  return prototype(entry).space_dimensions() > 0;
}

/// Returns the names of the initial data, the default first.
std::vector<std::string> initial_names(const model_entry& entry);

/// Returns the defaults of all parameters, options and lists. A velocity grid has 16 points on [−8, 8].
model_config default_config(const model_entry& entry);

/// Returns all models, sorted by name (generated).
std::vector<const model_entry*> model_entries();

/// Returns the entry called `name`; nullptr for an unknown name.
const model_entry* try_find_model(const std::string& name);
/// Returns the entry called `name`. Throws input_error with the nearest name for an unknown one.
const model_entry& find_model(const std::string& name);

}  // namespace apsis
