#include <apsis/phase/boundary.hpp>

#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <array>

namespace apsis {

namespace {

struct named_boundary {
  const char* name;
  boundary_kind kind;
};

constexpr std::array<named_boundary, 2> boundaries = {
    {{"periodic", boundary_kind::periodic}, {"outflow", boundary_kind::outflow}}};

/// The cell inside 0 … n−1 whose row stands at position i.
int inside(boundary_kind kind, int i, int n) {
  if (i >= 0 && i < n) return i;
  return kind == boundary_kind::outflow ? std::clamp(i, 0, n - 1) : ((i % n) + n) % n;
}

}  // namespace

std::vector<std::string> boundary_names() {
  std::vector<std::string> names;
  for (const auto& boundary : boundaries) names.emplace_back(boundary.name);
  return names;
}

boundary_kind find_boundary(const std::string& name) {
  for (const auto& boundary : boundaries)
    if (name == boundary.name) return boundary.kind;
  throw input_error("unknown boundary '" + name + "' " + suggest(name, boundary_names()));
}

void pencil_rows(const field& u, const grid& mesh, int direction, int pencil, boundary_kind kind, int begin,
                 int end, std::vector<const double*>& rows) {
  const int n = mesh.cells(direction);
  const int first = mesh.first_cell(direction, pencil);
  const int stride = mesh.stride(direction);
  rows.resize(static_cast<std::size_t>(end - begin));
  for (int i = begin; i < end; ++i)
    rows[static_cast<std::size_t>(i - begin)] = u.row(first + inside(kind, i, n) * stride);
}

}  // namespace apsis
