#include <apsis/study/case_problem.hpp>

#include <apsis/core/random_source.hpp>
#include <apsis/study/model_properties.hpp>

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace apsis {
namespace {

template <class Change>
void for_each_row(field& u, const Change& change) {
  for (int cell = 0; cell < u.cells(); ++cell)
    change(cell, std::span(u.row(cell), static_cast<std::size_t>(u.components())));
}

double smallest(const field& u) {
  double lowest = std::numeric_limits<double>::infinity();
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < u.components(); ++k)
      if (!(u.row(cell)[k] >= lowest)) lowest = u.row(cell)[k];
  return lowest;
}

}  // namespace

case_config small_case(const std::string& model, const std::string& method, double epsilon, int cells,
                       const std::vector<std::string>& overrides) {
  const model_entry* entry = try_find_model(model);
  const bool grid = entry != nullptr && entry->has_velocity_grid;
  const std::string text = fmt::format(
      "title = \"small\"\n[model]\nname = \"{}\"\nepsilon = {:.17g}\n"
      "[space]\ncells = {}\ndomain = [0.0, 2.0]\n{}[time]\nmethod = \"{}\"\nend = 1.0\ndt = 1.0\n",
      model, epsilon, cells, grid ? "[velocity]\nmax = 8.0\npoints = 16\n" : "", method);
  return parse_case(text, "small case of " + model, overrides);
}

std::vector<field> adversarial_states(case_problem& problem, int random, double vacuum, bool zeros) {
  const field start = problem.setup.initial_state();
  field equilibrium = start;
  problem.equations->solve_collision(0.0, std::numeric_limits<double>::max(), 0.0, equilibrium);
  std::vector<field> data{start, equilibrium};
  random_source source(7);
  for (int k = 0; k < random; ++k) {
    field u = start;
    for_each_row(u, [&](int cell, std::span<double> row) {
      const int kind = source.integer(0, 3);
      for (double& x : row) {
        const double factor = kind == 0 ? source.magnitude(-2, 0) : 1.0;
        x *= factor * (kind == 1 ? vacuum : 1.0) * (zeros && source.one_in(10) ? 0.0 : 1.0);
      }
      if (kind == 2) std::copy_n(equilibrium.row(cell), row.size(), row.begin());
    });
    data.push_back(std::move(u));
  }
  return data;
}

kept_property<field> positivity() {
  return stays_inside<field>("positivity", [](const field& u) { return -smallest(u); });
}

std::vector<std::string> all_entropy_models() {
  std::vector<std::string> names;
  for (const auto& m : all_models())
    if (has_space(*m.entry) && collisions_decrease_entropy(*m.equation)) names.push_back(m.entry->name);
  return names;
}

double entropy_of(const run_setup& setup, const field& u) {
  if (!(smallest(u) >= 0.0)) return std::numeric_limits<double>::quiet_NaN();
  const auto entropy = setup.equation->entropy();
  double sum = 0.0;
  for (int cell = 0; cell < u.cells(); ++cell) sum += entropy->density(u.row(cell));
  return setup.cell_volume() * sum;
}

kept_property<field> entropy_decay(const run_setup& setup) {
  return does_not_grow<field>("entropy", [&setup](const field& u) { return entropy_of(setup, u); }, 1e-14);
}

}  // namespace apsis
