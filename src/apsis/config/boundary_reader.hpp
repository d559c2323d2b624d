#pragma once

#include <apsis/config/case.hpp>
#include <apsis/config/case_text.hpp>

#include <vector>

namespace apsis {

/// Reads the variables "boundary.left.…" and "boundary.right.…" of the kinds in `config` into its tables.
/// Throws input_error at the place of a key: no such side, a variable that the kind does not have, no
/// formula, or a model that cannot have the kind.
void read_boundary_values(const case_text& text, const model& equation, case_config& config);

/// Returns the boundaries at both ends of every direction. Throws input_error at the place of the table or
/// the formula that is wrong.
std::vector<domain::faces> make_boundaries(const case_config& config, const model& equation);

}  // namespace apsis
