#pragma once

#include <apsis/config/case_text.hpp>
#include <apsis/config/initial_table.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/model/model.hpp>

#include <string>

namespace apsis {

/// Reads the keys "initial.…" of a case of the model called `name`. `constants` are those of its formulas.
/// Throws input_error at the place of a key that is unknown, whose value is not a formula, or that
/// conflicts with another.
initial_table read_initial_table(const case_text& text, const model& equation, const std::string& name,
                                 const formula_constants& constants);

}  // namespace apsis
