#include <apsis/space/boundary.hpp>

#include <apsis/core/suggest.hpp>

namespace apsis {

std::vector<std::string> boundary_names() {
  return {"periodic"};
}

boundary_kind find_boundary(const std::string& name) {
  if (name == "periodic") return boundary_kind::periodic;
  throw input_error("unknown boundary '" + name + "' " + suggest(name, boundary_names()));
}

void pencil_rows(const field& u, const grid& mesh, int direction, int pencil, boundary_kind, int begin,
                 int end, std::vector<const double*>& rows) {
  const int n = mesh.cells(direction);
  const int first = mesh.first_cell(direction, pencil);
  const int stride = mesh.stride(direction);
  rows.resize(static_cast<std::size_t>(end - begin));
  for (int i = begin; i < end; ++i) {
    const int inside = ((i % n) + n) % n;  // periodic
    rows[static_cast<std::size_t>(i - begin)] = u.row(first + inside * stride);
  }
}

}  // namespace apsis
