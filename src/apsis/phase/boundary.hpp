#pragma once

#include <apsis/phase/field.hpp>
#include <apsis/phase/grid.hpp>

#include <string>
#include <vector>

namespace apsis {

/// What lies beyond the ends of a pencil. This is the only place that knows it: everything else sees rows.
/// `outflow` is zero gradient: a ghost cell repeats the nearest cell inside.
enum class boundary_kind { periodic, outflow };

/// Names of all kinds in case files: "periodic", …
std::vector<std::string> boundary_names();
/// The kind of that name. Throws input_error with the nearest name if there is none.
boundary_kind find_boundary(const std::string& name);

/// rows[i − begin] ← the row of cell i of a pencil for i = begin … end−1; cells outside 0 … n−1 are ghost
/// cells.
void pencil_rows(const field& u, const grid& mesh, int direction, int pencil, boundary_kind kind, int begin,
                 int end, std::vector<const double*>& rows);

}  // namespace apsis
