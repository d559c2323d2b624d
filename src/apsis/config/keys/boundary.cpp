#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/internal/key_table.hpp>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Returns the key for the kind of all faces, another spelling of space.boundary.
case_key kind_of_all() {
  case_key all =
      key("boundary.all.kind", [](auto& c) -> auto& { return c.space.boundary; },
          {.scope = key_scope::space,
           .choices = names_in(boundary_entries),
           .doc = "In place of space.boundary: the boundary condition at every face without its own "
                  "kind. Further keys of the table [boundary.all] are variables of the kind for these "
                  "faces. Variables of a face, as in [boundary.left], override them."});
  all.load = [](const case_config&) -> case_value { return {}; };  // a written case has space.boundary
  return all;
}

/// Returns the keys for the kinds of the faces. Other keys of their tables are variables of the kinds.
std::vector<case_key> boundary_keys() {
  std::vector<case_key> all = {kind_of_all()};
  for (std::size_t k = 0; k < face_names.size(); ++k)
    all.push_back(
        key("boundary." + face_names[k] + ".kind", [k](auto& c) -> auto& { return c.faces[k].kind; },
            {.scope = key_scope::space,
             .choices = names_in(boundary_entries),
             .doc = fmt::format(
                 "Boundary condition at the {} end in {}, where it differs from "
                 "space.boundary. Further keys of the table [boundary.{}] are the variables "
                 "of the kind (apsis list boundaries): numbers, formulas in t and x, or tables in time, "
                 "T = {{ file = \"wall.csv\" }} with columns t and T. profile = {{ file = "
                 "\"results/earlier/solution.h5\", side = \"right\" }} gives rho, u and T of a side "
                 "of an earlier result.",
                 k % 2 == 0 ? "lower" : "upper", "xyz"[k / 2], face_names[k])}));
  return all;
}

}  // namespace

extern const key_table_entry key_table_boundary;
const key_table_entry key_table_boundary = {.place = 60, .keys = boundary_keys};

}  // namespace apsis
