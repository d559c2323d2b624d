#pragma once

#include <apsis/config/case_text.hpp>
#include <apsis/config/initial_table.hpp>
#include <apsis/model/model.hpp>

#include <string>

namespace apsis {

/// Reads the keys "initial.…" of a case of the model called `name`. Throws input_error at the place of a key
/// that is unknown or whose value is not a formula.
initial_table read_initial_table(const case_text& text, const model& equation, const std::string& name);

}  // namespace apsis
