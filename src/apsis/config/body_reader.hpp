#pragma once

#include <apsis/config/case.hpp>
#include <apsis/config/case_text.hpp>
#include <apsis/mesh/cut_cells.hpp>

#include <memory>
#include <string>

namespace apsis {

/// Reads the tables [[space.body]] into `config`, whose mesh is known. Throws input_error at the place of a
/// key for an unknown shape or key, or a value of another kind. Also throws it for a repeated name, or a
/// mesh of one dimension.
void read_bodies(const case_text& text, const model& equation, case_config& config);

/// Returns why a body cannot have a kind of wall, with the kinds that it can have with a model.
std::string why_no_wall_of_bodies(const std::string& kind, const model& equation);

/// Returns the cells of a mesh that the bodies of a case cut, made once for a case and its copies. `mesh` is
/// that of the case with its solid boxes. Throws input errors of cut_cells and of the shapes at the place of
/// a body. Throws io_error if a file cannot be read.
std::shared_ptr<const cut_cells> cut_cells_of(const case_config& config, const grid& mesh);

}  // namespace apsis
