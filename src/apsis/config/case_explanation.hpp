#pragma once

#include <apsis/config/case.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Where the value of a key comes from.
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

/// Returns every key that the model of the case uses, in the order of the schema, then the parameters of the
/// model, then the keys of the tables of formulas.
std::vector<explained_value> explain(const case_config& config);

/// Returns explain() as lines "key = value    origin (reason)", in columns.
std::string explanation_text(const case_config& config);

}  // namespace apsis
