#include <apsis/run/compute_fields.hpp>

#include <apsis/semidiscrete/gathered_cells.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

namespace apsis {
namespace {

bool names_one_of(const std::vector<std::string>& wanted, const std::vector<field_name>& names) {
  return std::any_of(names.begin(), names.end(), [&](const field_name& one) {
    return std::find(wanted.begin(), wanted.end(), one.name) != wanted.end();
  });
}

/// Value of the fields in solid cells.
constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

void add_names(field_table& table, const std::vector<field_name>& names) {
  for (const auto& one : names) {
    table.names.push_back(one.name);
    table.labels.push_back(one.label);
    table.dimensions.push_back(one.dimension);
  }
}

using gradient = std::array<double, 3>;

/// Computes the derivatives of φ along a direction, within the segments of its pencils.
void differentiate(const domain& space, int direction, const field& phi, std::vector<gradient>& slopes) {
  const int stride = space.mesh().stride(direction);
  const auto& segments = space.segments().along(direction);
  for (int number = 0; number < static_cast<int>(segments.size()); ++number) {
    const segment& one = segments[static_cast<std::size_t>(number)];
    const int n = one.cells;
    // Values of the cells across the two ends, on another process or beyond a periodic face; null
    // where the gas ends.
    const double* before = space.row_across(phi, direction, number, false);
    const double* after = space.row_across(phi, direction, number, true);
    for (int k = 0; k < n; ++k) {
      const int cell = one.first + k * stride;
      const double *here = phi.row(cell), *below = k > 0 ? phi.row(cell - stride) : before,
                   *above = k < n - 1 ? phi.row(cell + stride) : after;
      const int intervals =
          (below == nullptr || below == here ? 0 : 1) + (above == nullptr || above == here ? 0 : 1);
      // A field has cells, so that `here` is a row.
      // NOLINTNEXTLINE(clang-analyzer-core.NullDereference)
      const double rise = *(above == nullptr ? here : above) - *(below == nullptr ? here : below);
      slopes[static_cast<std::size_t>(cell)][static_cast<std::size_t>(direction)] =
          intervals == 0 ? 0.0 : rise / (intervals * space.mesh().spacing(direction));
    }
  }
}

/// Returns ∇φ of every cell.
std::vector<gradient> gradients_of(const run_setup& setup, const std::vector<double>& phi) {
  std::vector<gradient> slopes(phi.size(), gradient{});
  if (!setup.has_space()) return slopes;
  const auto made = setup.builder().make_space();
  domain& space = *made;
  space.reserve(1, 1);
  field values(static_cast<int>(phi.size()), 1);
  for (int cell = 0; cell < values.cells(); ++cell) *values.row(cell) = phi[static_cast<std::size_t>(cell)];
  space.exchange(values);
  for (int direction = 0; direction < setup.mesh().dimensions(); ++direction)
    differentiate(space, direction, values, slopes);
  return slopes;
}

/// Completes the gradient of the velocity about an axis. The unit vectors e_r and e_θ turn with θ. Therefore
/// u_r e_r + u_θ e_θ changes along θ by u_r/r e_θ − u_θ/r e_r per unit length.
void add_turning(const run_setup& setup, const field_table& table, std::vector<std::vector<gradient>>& of) {
  const grid& mesh = setup.mesh();
  if (!mesh.has_axis()) return;
  // Field 0 is ρ. The velocity along r is the component of the last direction; the one along θ follows it.
  const auto r = static_cast<std::size_t>(mesh.dimensions() - 1), angle = r + 1;
  for (int cell = 0; cell < mesh.size(); ++cell) {
    const auto c = static_cast<std::size_t>(cell);
    const double radius = mesh.radius(mesh.centre(cell));
    of[1 + r][c][angle] = -table.values[1 + angle][c] / radius;
    of[1 + angle][c][angle] = table.values[1 + r][c] / radius;
  }
}

/// Adds a group of fields to a table whose first columns are those of model::default_fields().
void add_group(const run_setup& setup, const field& u, const field_group& group, field_table& table) {
  std::vector<std::vector<gradient>> of_fields;  // [field][cell]
  std::vector<double> epsilon;
  if (group.needs_gradients) {
    const std::size_t usual = setup.equation->default_fields().size();
    for (std::size_t k = 0; k < usual; ++k) of_fields.push_back(gradients_of(setup, table.values[k]));
    add_turning(setup, table, of_fields);
    epsilon = setup.epsilon_at_centres();
  }
  const std::size_t first = table.values.size();
  add_names(table, group.names);
  table.values.resize(table.names.size());
  std::vector<double> values(group.names.size());
  std::vector<gradient> gradients(of_fields.size());
  for (int cell = 0; cell < u.cells(); ++cell) {
    const auto c = static_cast<std::size_t>(cell);
    if (setup.mesh().solid(cell) >= 0) {
      std::fill(values.begin(), values.end(), undefined);
    } else {
      for (std::size_t k = 0; k < gradients.size(); ++k) gradients[k] = of_fields[k][c];
      group.compute({u.row(cell), epsilon.empty() ? 0.0 : epsilon[c], gradients}, values.data());
    }
    for (std::size_t k = 0; k < values.size(); ++k) table.values[first + k].push_back(values[k]);
  }
}

/// Adds the shape of the whole mesh and, on the root only, the centres of its cells.
void add_centres(const run_setup& setup, field_table& table) {
  const grid& mesh = setup.whole_mesh();
  for (int direction = 0; direction < mesh.dimensions(); ++direction)
    table.shape.push_back(mesh.cells(direction));
  if (!setup.processes().is_root()) return;
  const std::array columns = {&table.x, &table.y, &table.z};
  for (int direction = 0; direction < mesh.dimensions(); ++direction)
    for (int cell = 0; cell < mesh.size(); ++cell)
      columns.at(static_cast<std::size_t>(direction))
          ->push_back(setup.has_space() ? mesh.centre(cell, direction) : 0.0);
}

}  // namespace

field_table compute_fields(const run_setup& setup, const field& u) {
  const auto& wanted = setup.config().output.fields;
  field_table table;
  add_centres(setup, table);
  for (const field_group& group : setup.equation->fields())
    if (table.names.empty() || names_one_of(wanted, group.names)) add_group(setup, u, group, table);
  for (auto& column : table.values) column = gather_cells(setup.builder(), std::move(column));
  return table;
}

}  // namespace apsis
