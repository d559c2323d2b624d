#pragma once

#include <apsis/config/case.hpp>
#include <apsis/config/case_text.hpp>

#include <memory>
#include <vector>

namespace apsis {

/// Reads the tables [[space.solid]] into `config`, whose mesh is known. Throws input_error at the place of a
/// key if it gives no box, repeats a name, or is no variable of the kind of wall.
void read_solids(const case_text& text, const model& equation, case_config& config);

/// Returns the solid boxes of a case as cells of its mesh. Throws input_error unless every face lies on edges
/// of cells inside the domain.
std::vector<cell_box> solid_boxes(const case_config& config, const grid& mesh);

/// Returns the wall of each solid box, and then of each body, made once for a case and its copies. Throws
/// input_error at the place of the table or the formula that is wrong.
std::vector<std::shared_ptr<const boundary>> make_solid_walls(const case_config& config,
                                                              const std::shared_ptr<const model>& equation);

}  // namespace apsis
