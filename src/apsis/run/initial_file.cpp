#include <apsis/run/initial_file.hpp>

#include <apsis/config/prescribed_data.hpp>
#include <apsis/core/log.hpp>
#include <apsis/exec/interruption.hpp>
#include <apsis/mesh/cell_at.hpp>
#include <apsis/run/initial_table_file.hpp>
#include <apsis/scheme/cell_polynomials.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

std::size_t size(int n) {
  return static_cast<std::size_t>(n);
}

/// Returns the possible column names of a variable, in order of preference.
std::vector<std::string> columns_of(const data_variable& variable, int k) {
  static const char* const axes[] = {"_x", "_y", "_z"};
  if (variable.size > 1) return {variable.name + axes[k]};
  return {variable.name, variable.name + "_x"};  // "_x" for a vector along a line
}

class reader {
 public:
  reader(const case_config& config, const model& equation)
      : config_(config), equation_(equation), source_(config, equation) {}

  /// Returns the rows, and whether they stand for the equilibria of their moments.
  std::pair<line_rows, bool> read() {
    line_rows rows;
    rows.components = equation_.components();
    rows.second_moment = source_.unknown().second_moment();
    bool equilibrium = false;
    if (source_.has_state()) {
      rows.values = source_.state();
      rows.cells = static_cast<int>(rows.values.size() / size(rows.components));
    } else {
      equilibrium = make_rows(rows);
    }
    if (equation_.space_dimensions() > 1)
      source_.check_cells(make_mesh(config_), rows.cells);
    else if (equation_.space_dimensions() > 0)
      set_ends(rows);
    else if (rows.cells != 1)
      source_.refuse(fmt::format("it has {} rows (the model has no space); give one", rows.cells));
    log::info(fmt::format("initial data: {} of '{}', {} cells",
                          equilibrium ? "equilibria with the fields" : "the state", config_.prescribed.file,
                          rows.cells));
    return {std::move(rows), equilibrium};
  }

 private:
  /// Returns the form with the most variables for which the file has all columns. Forms with fewer variables
  /// describe equilibria.
  data_form form_in_file() const {
    std::optional<data_form> best;
    std::vector<std::string> missing;
    for (const auto& form : equation_.data_forms()) {
      if (form.variables.front().of_velocity) continue;
      bool complete = true;
      for (const auto& variable : form.variables)
        for (int k = 0; k < variable.size; ++k)
          if (!source_.has_any(columns_of(variable, k))) {
            if (complete && missing.empty()) missing = columns_of(variable, k);
            complete = false;
          }
      if (complete && (!best || form.variables.size() > best->variables.size())) best = form;
    }
    if (!best)
      source_.refuse(missing.empty() ? std::string("the model has only named data; write model.initial")
                                     : fmt::format("it has no column '{}' (its columns are {}); add it",
                                                   missing.front(), fmt::join(source_.columns(), ", ")));
    return *best;
  }

  bool make_rows(line_rows& rows) const {
    const data_form form = form_in_file();
    std::vector<std::vector<double>> given;
    for (const auto& variable : form.variables)
      for (int k = 0; k < variable.size; ++k)
        given.push_back(source_.column(columns_of(variable, k), variable.dimension));
    rows.cells = static_cast<int>(given.front().size());
    const std::vector<bool> solid = source_.solid_rows(given.front().size());
    std::vector<double> numbers(given.size()), row(size(rows.components));
    for (int cell = 0; cell < rows.cells; ++cell) {
      interruptible::poll();
      for (std::size_t k = 0; k < given.size(); ++k) numbers[k] = given[k][size(cell)];
      if (solid[size(cell)]) {
        rows.values.insert(rows.values.end(), row.size(), 0.0);
        continue;
      }
      const std::string problem = form.row(numbers, row);
      if (!problem.empty())
        source_.refuse(fmt::format("{} has no {} ({}); change its numbers", source_.place_of_row(size(cell)),
                                   form.description, problem));
      rows.values.insert(rows.values.end(), row.begin(), row.end());
    }
    return static_cast<int>(given.size()) < rows.components;
  }

  /// Sets the ends of the line. An end becomes that of the domain if both agree up to the digits of the file.
  void set_ends(line_rows& rows) const {
    const auto [lower, upper, tolerance] = source_.ends(rows.cells);
    const auto [first, last] = config_.space.domain.front();
    const double near = tolerance * (upper - lower) / rows.cells;
    rows.lower = std::abs(lower - first) <= near ? first : lower;
    rows.upper = std::abs(upper - last) <= near ? last : upper;
    if (rows.lower > first || rows.upper < last)
      source_.refuse(
          fmt::format("its cells cover [{:.10g}, {:.10g}] (the domain is [{:.10g}, {:.10g}]); change "
                      "space.domain, or give data on all of it",
                      lower, upper, first, last));
  }

  const case_config& config_;
  const model& equation_;
  initial_table_file source_;
};

/// u ← E(ℛu), so that interpolated equilibria are equilibria at every point.
void project(const model& equation, std::span<double> u) {
  const auto* relaxation = equation.as_relaxation();
  if (relaxation == nullptr) return;
  std::vector<double> omega(size(relaxation->moment_count()));
  relaxation->moments(u.data(), omega.data());
  relaxation->equilibrium(omega.data(), u.data());
}

/// Returns the rows of the file for the cells of this block. The file must have the mesh of the case.
field copied(const line_rows& rows, const problem_builder& builder) {
  const grid& mesh = builder.mesh();
  field u(builder.has_space() ? mesh.size() : rows.cells, rows.components);
  for (int cell = 0; cell < u.cells(); ++cell) {
    const int there = builder.has_space() ? builder.whole_mesh().cell_of(mesh, cell) : cell;
    const double* from = rows.values.data() + static_cast<std::ptrdiff_t>(there) * rows.components;
    const double r = builder.has_space() ? mesh.radius(mesh.centre(cell)) : 1.0;
    std::transform(from, from + rows.components, u.row(cell), [r](double f) { return r * f; });
  }
  return u;
}

/// Returns the rows of the file on the mesh of the case, in several dimensions. Regions of the
/// case override them.
state_of_file on_the_same_mesh(const case_config& config, const model& equation,
                               const problem_builder& builder, const line_rows& rows, bool equilibrium) {
  if (config.prescribed.regions.empty()) return {copied(rows, builder), !equilibrium};
  const grid& mesh = builder.whole_mesh();
  const prescribed_data data(
      config, equation, [&config](const std::string& path) { return place_of(config, path); },
      [&](const position& x, std::span<double> u) {
        const int cell = cell_at(mesh, x);  // point values are sampled only at centres
        std::copy_n(rows.values.begin() + static_cast<std::ptrdiff_t>(cell) * rows.components,
                    rows.components, u.begin());
      });
  return {builder.sample([&data](const position& x, std::span<double> u) { data(x, u); }, {}), false};
}

}  // namespace

state_of_file sample_initial_file(const case_config& config, const model& equation,
                                  const problem_builder& builder) {
  const grid& mesh = builder.whole_mesh();
  const auto [rows, equilibrium] = reader(config, equation).read();
  if (mesh.dimensions() > 1) return on_the_same_mesh(config, equation, builder, rows, equilibrium);
  const bool on_line = builder.has_space();
  const cell_unknown& unknown = builder.of_space().unknown();
  const bool same_mesh =
      !on_line ||
      (rows.cells == mesh.size() && rows.second_moment == unknown.second_moment() &&
       rows.lower == config.space.domain.front()[0] && rows.upper == config.space.domain.front()[1]);
  if (same_mesh && config.prescribed.regions.empty() && (!equilibrium || unknown.pointwise() || !on_line))
    return {copied(rows, builder), !equilibrium};
  const cell_polynomials between(rows, equation.positive());
  const bool project_rows = equilibrium;
  const prescribed_data data(
      config, equation, [&config](const std::string& path) { return place_of(config, path); },
      [&between, &equation, project_rows](const position& x, std::span<double> u) {
        between(x[0], u);
        if (project_rows) project(equation, u);
      });
  std::vector<double> jumps = between.jumps();
  for (const double x : data.jumps(mesh)) jumps.push_back(x);
  std::sort(jumps.begin(), jumps.end());
  return {builder.sample([&data](const position& x, std::span<double> u) { data(x, u); }, jumps),
          !equilibrium && config.prescribed.regions.empty()};
}

}  // namespace apsis
