#pragma once

#include <apsis/config/case.hpp>
#include <apsis/config/case_text.hpp>

#include <string>

namespace apsis {

/// Resolves the flat keys of a case: checks every key by the schema, fills in defaults, and checks keys
/// against each other. `file` is the name of the text in messages. Throws input_error with the place of the
/// key.
case_config resolve_case(case_text text, const std::string& file);

}  // namespace apsis
