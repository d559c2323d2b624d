#include <apsis/run/find_fields.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace apsis {
namespace {

bool names_one_of(const std::vector<std::string>& wanted, const std::vector<field_name>& names) {
  return std::any_of(names.begin(), names.end(), [&](const field_name& one) {
    return std::find(wanted.begin(), wanted.end(), one.name) != wanted.end();
  });
}

void add_names(field_table& table, const std::vector<field_name>& names) {
  for (const auto& one : names) {
    table.names.push_back(one.name);
    table.labels.push_back(one.label);
    table.measures.push_back(one.measure);
  }
}

/// Adds the squares of the derivatives of φ along a direction.
void add_squares(const grid& mesh, int direction, bool periodic, const std::vector<double>& phi,
                 std::vector<double>& sum) {
  const int n = mesh.cells(direction), stride = mesh.stride(direction);
  for (int pencil = 0; pencil < mesh.pencils(direction); ++pencil) {
    const int first = mesh.first_cell(direction, pencil);
    const auto at = [&](int k) {
      const int cell = first + k * stride;
      return static_cast<std::size_t>(cell);
    };
    for (int k = 0; k < n; ++k) {
      const int below = k > 0 ? k - 1 : (periodic ? n - 1 : 0);
      const int above = k < n - 1 ? k + 1 : (periodic ? 0 : n - 1);
      const double distance = (periodic || (k > 0 && k < n - 1) ? 2.0 : 1.0) * mesh.spacing(direction);
      const double slope = (phi[at(above)] - phi[at(below)]) / distance;
      sum[at(k)] += slope * slope;
    }
  }
}

/// Returns |∇φ| of every cell.
std::vector<double> size_of_gradient(const run_setup& setup, const std::vector<double>& phi) {
  std::vector<double> sum(phi.size(), 0.0);
  if (setup.has_space())
    for (int direction = 0; direction < setup.mesh().dimensions(); ++direction)
      add_squares(setup.mesh(), direction, setup.periodic(direction), phi, sum);
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
    equation.macroscopic(u.row(cell), values.data());
    if (values.size() > usual) equation.further_macroscopic(u.row(cell), values.data() + usual);
    for (std::size_t k = 0; k < values.size(); ++k) table.values[k].push_back(values[k]);
  }
  if (names_one_of(wanted, equation.gradient_fields())) add_gradient_fields(setup, u, usual, table);
  return table;
}

}  // namespace apsis
