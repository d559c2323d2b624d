#pragma once

#include <apsis/model/model.hpp>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// A number that a model can be given in its case file.
struct model_parameter {
  std::string name;      ///< key in the table [model]
  double value;          ///< default
  double lowest;         ///< smallest allowed value
  double highest;        ///< largest allowed value
  std::string doc;       ///< meaning and unit
  bool integer = false;  ///< only whole numbers have a meaning
};

/// A text that a model can be given in its case file: one of its names, or a formula.
struct model_text {
  std::string name;                  ///< key in the table [model]
  std::string value;                 ///< default
  std::vector<std::string> choices;  ///< names with a meaning of their own
  std::string variable;              ///< what a formula is written in, any finite value; "": names only
  std::string doc;                   ///< meaning
};

/// Velocity grid of a kinetic model: `points` midpoints on [−max, max] per velocity dimension.
struct velocity_config {
  double max = 0.0;                  ///< v_max > 0 (dimensionless)
  int points = 0;                    ///< at least 4
  std::string equilibrium = "auto";  ///< "auto" | "formula" | "discrete"
};

/// All that a model is made from.
struct model_config {
  std::map<std::string, double> parameters;  ///< complete: defaults filled in
  std::map<std::string, std::string> texts;  ///< likewise; each a choice or a formula that can be read
  velocity_config velocity;                  ///< only where the entry has_velocity
};

/// One equation of the registry: a file of model/models/ defines `extern const model_entry model_<file>`.
struct model_entry {
  std::string name;                         ///< value of the key model.name
  std::string description;                  ///< one line with the equation
  std::string source;                       ///< citation
  bool has_space;                           ///< needs the table [space]
  bool has_velocity;                        ///< needs the table [velocity]
  bool has_epsilon;                         ///< takes the key model.epsilon
  std::vector<model_parameter> parameters;  ///< in the order in which they are documented
  std::vector<std::string> initial;         ///< names of its initial data, default first
  /// Throws input_error where the velocity grid or a formula cannot be used.
  std::unique_ptr<model> (*make)(const model_config&);
  std::vector<model_text> texts = {};  ///< in the same order
};

/// What the model is made from if its case file says nothing; the velocity grid is left to the caller.
model_config default_config(const model_entry& entry);

/// Every model, sorted by name (generated).
std::vector<const model_entry*> model_entries();

/// The entry called `name`; nullptr if there is none.
const model_entry* find_model(const std::string& name);

}  // namespace apsis
