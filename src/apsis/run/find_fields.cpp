#include <apsis/run/find_fields.hpp>

#include <apsis/run/gathered_cells.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace apsis {
namespace {

bool names_one_of(const std::vector<std::string>& wanted, const std::vector<field_name>& names) {
  return std::any_of(names.begin(), names.end(), [&](const field_name& one) {
    return std::find(wanted.begin(), wanted.end(), one.name) != wanted.end();
  });
}

/// The fields of solid cells.
constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

void add_names(field_table& table, const std::vector<field_name>& names) {
  for (const auto& one : names) {
    table.names.push_back(one.name);
    table.labels.push_back(one.label);
    table.measures.push_back(one.measure);
  }
}

/// Adds the squares of the derivatives of φ along a direction, within the segments of its pencils.
void add_squares(const domain& space, int direction, const field& phi, std::vector<double>& sum) {
  const int stride = space.mesh().stride(direction);
  const auto& segments = space.segments().along(direction);
  for (int number = 0; number < static_cast<int>(segments.size()); ++number) {
    const segment& one = segments[static_cast<std::size_t>(number)];
    const int n = one.cells;
    // The cell across an end, of another process or across periodic faces; none where the gas ends.
    const double* before = space.row_across(phi, direction, number, false);
    const double* after = space.row_across(phi, direction, number, true);
    for (int k = 0; k < n; ++k) {
      const int cell = one.first + k * stride;
      const double *here = phi.row(cell), *below = k > 0 ? phi.row(cell - stride) : before,
                   *above = k < n - 1 ? phi.row(cell + stride) : after;
      const int intervals =
          (below == nullptr || below == here ? 0 : 1) + (above == nullptr || above == here ? 0 : 1);
      const double rise = *(above == nullptr ? here : above) - *(below == nullptr ? here : below);
      const double slope = intervals == 0 ? 0.0 : rise / (intervals * space.mesh().spacing(direction));
      sum[static_cast<std::size_t>(cell)] += slope * slope;
    }
  }
}

/// Returns |∇φ| of every cell.
std::vector<double> size_of_gradient(const run_setup& setup, const std::vector<double>& phi) {
  std::vector<double> sum(phi.size(), 0.0);
  if (setup.has_space()) {
    const auto made = setup.builder().make_space();
    domain& space = *made;
    space.reserve(1, 1);
    field values(static_cast<int>(phi.size()), 1);
    for (int cell = 0; cell < values.cells(); ++cell) *values.row(cell) = phi[static_cast<std::size_t>(cell)];
    space.exchange(values);
    for (int direction = 0; direction < setup.mesh().dimensions(); ++direction)
      add_squares(space, direction, values, sum);
  }
  for (double& x : sum) x = std::sqrt(x);
  return sum;
}

void add_gradient_fields(const run_setup& setup, const field& u, std::size_t usual, field_table& table) {
  const model& equation = *setup.equation;
  const auto names = equation.gradient_fields();
  add_names(table, names);
  std::vector<std::vector<double>> sizes;
  for (std::size_t k = 0; k < usual; ++k) sizes.push_back(size_of_gradient(setup, table.values[k]));
  const std::size_t first = table.values.size();
  table.values.resize(first + names.size());
  const std::vector<double> epsilon = setup.epsilon_at_centres();
  std::vector<double> gradients(usual), values(names.size());
  for (int cell = 0; cell < u.cells(); ++cell) {
    const auto c = static_cast<std::size_t>(cell);
    if (setup.mesh().solid(cell) >= 0) {
      for (std::size_t k = 0; k < values.size(); ++k) table.values[first + k].push_back(undefined);
      continue;
    }
    for (std::size_t k = 0; k < usual; ++k) gradients[k] = sizes[k][c];
    equation.gradient_macroscopic(u.row(cell), epsilon[c], gradients.data(), values.data());
    for (std::size_t k = 0; k < values.size(); ++k) table.values[first + k].push_back(values[k]);
  }
}

/// Of the whole mesh, on the root alone.
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

field_table find_fields(const run_setup& setup, const field& u) {
  const model& equation = *setup.equation;
  const auto& wanted = setup.config().output.fields;
  field_table table;
  add_names(table, equation.fields());
  const std::size_t usual = table.names.size();
  if (names_one_of(wanted, equation.further_fields())) add_names(table, equation.further_fields());
  add_centres(setup, table);
  table.values.assign(table.names.size(), {});
  std::vector<double> values(table.names.size());
  for (int cell = 0; cell < u.cells(); ++cell) {
    if (setup.mesh().solid(cell) >= 0) {
      for (auto& column : table.values) column.push_back(undefined);
      continue;
    }
    equation.macroscopic(u.row(cell), values.data());
    if (values.size() > usual) equation.further_macroscopic(u.row(cell), values.data() + usual);
    for (std::size_t k = 0; k < values.size(); ++k) table.values[k].push_back(values[k]);
  }
  if (names_one_of(wanted, equation.gradient_fields())) add_gradient_fields(setup, u, usual, table);
  for (auto& column : table.values) column = gather_cells(setup.builder(), std::move(column));
  return table;
}

}  // namespace apsis
