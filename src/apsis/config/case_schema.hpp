#pragma once

#include <apsis/config/case.hpp>
#include <apsis/model/dimension.hpp>
#include <apsis/model/model_registry.hpp>

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace apsis {

/// An interval of space, [lower, upper].
using interval = std::array<double, 2>;

/// Value of a key; std::monostate if an optional key is not set.
using case_value = std::variant<std::monostate, long, double, std::string, std::vector<std::string>,
                                std::vector<long>, std::vector<interval>, std::vector<std::vector<double>>>;

/// The values that a key takes.
enum class key_type {
  integer,    ///< long
  number,     ///< double; an integer of TOML too
  text,       ///< std::string
  quantity,   ///< std::string: a number > 0 with a unit, "10 Pa"
  formula,    ///< std::string: a formula in x, y, z, or a number, written as text
  text_list,  ///< std::vector<std::string>
  formulas,   ///< std::vector<std::string>: formulas or numbers, one alone is written without brackets
  integers,   ///< std::vector<long>: one for each direction; one alone is written without brackets
  intervals,  ///< std::vector<interval>: one for each direction; one alone is written without outer brackets
  points      ///< std::vector<std::vector<double>>: lists of coordinates
};

/// The models to which a key belongs. A key that the model does not use is an error, not ignored.
enum class key_scope {
  always,   ///< all
  space,    ///< those with space
  velocity  ///< those with a velocity grid
};

/// One key of a case file. The tables of keys (config/keys/) drive reading, writing and documentation.
struct case_key {
  std::string path{};                   ///< "space.cells"
  key_type type = key_type::text;       ///< which alternative of case_value it has
  key_scope scope = key_scope::always;  ///< models that use it
  bool required = false;                ///< if false, the default is that of case_config
  /// Returns whether keys that were read before make a required key optional.
  std::function<bool(const case_config&)> optional = {};
  std::string unit{};            ///< "dimensionless", "steps", …; "" for text
  apsis::dimension dimension{};  ///< with a table [gas], values with units of this dimension are valid
  double lowest = -infinite,     ///< smallest allowed number
      highest = infinite;        ///< largest allowed number
  bool lowest_excluded = false;  ///< only numbers above `lowest`
  std::function<std::vector<std::string>(const case_config&)> choices = {};  ///< valid names; empty: any text
  std::string doc{};  ///< meaning, as `apsis show case` prints it
  std::function<void(case_config&, const case_value&)> store = {};  ///< assigns a checked value
  std::function<case_value(const case_config&)> load = {};  ///< monostate if an optional key is not set
  /// Judges a name outside `choices`. Returns "" if it is valid, the reason if it is nearly
  /// valid, otherwise nothing.
  std::function<std::optional<std::string>(const std::string& name)> also = {};

  static constexpr double infinite = std::numeric_limits<double>::infinity();  ///< no limit
};

/// Returns every key except the parameters of the models, in the order in which they are read and written.
const std::vector<case_key>& case_schema();

/// Returns the keys that set the step: time.dt, time.cfl, time.safety. A case has one of them.
const std::vector<std::string>& step_keys();

/// Returns whether a key is one of step_keys().
bool is_step_key(const std::string& key);

/// Returns whether a case of this model may have the key.
bool applies(const case_key& key, const model_entry& model);

/// Returns "an integer", "a number", … for messages and documentation.
std::string type_text(key_type type);

/// Returns "at least 1 and at most 100", "above 0"; "" without limits.
std::string range_text(const case_key& key);

/// Returns the value as TOML.
std::string to_toml(const case_value& value);

/// Returns the documentation of every key: type, unit, default, allowed values and meaning. It includes the
/// parameters of the models.
std::string schema_text();

/// Returns the case as the text of a file, with the keys that its model uses. parse_case reads it
/// back to the same case.
std::string to_toml(const case_config& config);

}  // namespace apsis
