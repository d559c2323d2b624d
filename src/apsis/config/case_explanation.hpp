#pragma once

#include <apsis/config/case.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Origin of the value of a key.
enum class value_origin {
  given,          ///< the case or an override sets it
  default_value,  ///< it is the default of the key
  derived         ///< it follows from other keys, or the program chose it
};

/// Returns "given", "default" or "derived".
std::string to_string(value_origin origin);

/// A key of a resolved case with its value and its origin.
struct explained_value {
  std::string key,      ///< "time.method"
      value;            ///< as in a case file; "" for keys of formulas, which are all given
  value_origin origin;  ///< where the value comes from
  std::string reason;   ///< why a value was chosen; "" if nothing explains it
};

/// Returns every key that the model of the case uses: the keys of the schema in their order, the parameters
/// of the model, and the keys of tables of formulas.
std::vector<explained_value> explain(const case_config& config);

/// Returns explain() as lines "key = value    origin (reason)", in columns.
std::string explanation_text(const case_config& config);

}  // namespace apsis
