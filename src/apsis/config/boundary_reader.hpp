#pragma once

#include <apsis/config/case.hpp>
#include <apsis/config/case_text.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// Reads the variables "boundary.left.…" and "boundary.right.…" of the kinds in `config` into its tables.
/// Throws input_error at the place of a key if there is no such side, or if the kind has no such variable.
/// Also throws it if a value is no formula, or if the model cannot have the kind.
void read_boundary_values(const case_text& text, const model& equation, case_config& config);

/// Returns the names of the variables of a kind of boundary. Throws input_error at a place if there is no
/// such kind, or the model cannot have it.
std::vector<std::string> boundary_variables(const std::string& kind, const model& equation,
                                            const source_place& place);

/// Returns the place that describes a face, a solid box or the source, by the path of its table. It is the
/// first known place among the table, [boundary.all] for a face without a table, its kind, another of its
/// keys, and space.boundary.
source_place place_of_emitter(const case_config& config, const std::string& path);

/// Returns the boundary of a kind with formulas for its variables, which are the keys "path.NAME". Throws
/// input_error at the place of the table or the formula that is wrong.
std::shared_ptr<const boundary> make_wall(const case_config& config, const model& equation,
                                          const std::string& path, const std::string& kind,
                                          const state_formulas& values);

/// Returns the boundaries at both ends of every direction, made once for a case and its copies. Throws
/// input_error at the place of the table or the formula that is wrong.
std::vector<domain::faces> make_boundaries(const case_config& config,
                                           const std::shared_ptr<const model>& equation);

}  // namespace apsis
