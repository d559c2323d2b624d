#include <apsis/run/find_fields.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
void add_squares(const domain& space, int direction, const std::vector<double>& phi,
                 std::vector<double>& sum) {
  const int stride = space.mesh().stride(direction);
  for (const segment& one : space.segments().along(direction)) {
    const int n = one.cells;
    const auto at = [&](int k) { return static_cast<std::size_t>(one.first + k * stride); };
    // The cell beyond an end across periodic faces, or the one at the end.
    const auto beyond = [&](bool upper) {
      const auto& [surface, place] = one.ends[upper ? 1 : 0];
      if (surface >= 0) return at(upper ? n - 1 : 0);
      const segment& next = space.segment_at(direction, place);
      return static_cast<std::size_t>(next.first + (upper ? 0 : (next.cells - 1) * stride));
    };
    for (int k = 0; k < n; ++k) {
      const std::size_t below = k > 0 ? at(k - 1) : beyond(false),
                        above = k < n - 1 ? at(k + 1) : beyond(true);
      const int intervals = (below == at(k) ? 0 : 1) + (above == at(k) ? 0 : 1);
      const double slope =
          intervals == 0 ? 0.0 : (phi[above] - phi[below]) / (intervals * space.mesh().spacing(direction));
      sum[at(k)] += slope * slope;
    }
  }
}

/// Returns |∇φ| of every cell.
std::vector<double> size_of_gradient(const run_setup& setup, const std::vector<double>& phi) {
  std::vector<double> sum(phi.size(), 0.0);
  if (setup.has_space()) {
    const domain space = setup.builder().space();
    for (int direction = 0; direction < setup.mesh().dimensions(); ++direction)
      add_squares(space, direction, phi, sum);
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

void add_centres(const run_setup& setup, field_table& table) {
  const grid& mesh = setup.mesh();
  table.x = setup.centres();
  const std::array further = {&table.y, &table.z};
  for (int direction = 0; direction < mesh.dimensions(); ++direction) {
    table.shape.push_back(mesh.cells(direction));
    if (direction == 0) continue;
    std::vector<double>& centres = *further.at(static_cast<std::size_t>(direction) - 1);
    for (int cell = 0; cell < mesh.size(); ++cell) centres.push_back(mesh.centre(cell, direction));
  }
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
  return table;
}

}  // namespace apsis
