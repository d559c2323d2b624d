#pragma once

#include <apsis/config/case_schema.hpp>
#include <apsis/config/case_text.hpp>

#include <string>

namespace apsis {

/// The value of a key in the type of its key, checked against its range and its choices; `so_far` holds the
/// keys that were read before (the choices of initial data depend on the model). Throws input_error at the
/// place of the key.
case_value to_value(const case_key& key, const raw_value& raw, const case_config& so_far);

/// One of the names of the text, or a formula in its variable. Throws input_error at the place of the key, or
/// within the formula.
std::string to_text(const model_text& text, const raw_value& raw);

/// What a value of the type looks like, for the suggestion of a message: "write for example 100".
std::string type_advice(key_type type);

/// A finite number. `needed` says what the key takes ("a number"). Throws input_error.
double finite_number(const raw_value& raw, const std::string& path, const std::string& needed);

/// Throws input_error at the place of the key: "'path' is `raw.what` (why) advice".
[[noreturn]] void refuse(const raw_value& raw, const std::string& path, const std::string& why,
                         const std::string& advice);

}  // namespace apsis
