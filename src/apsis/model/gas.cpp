#include <apsis/model/gas.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/model/formulas/reduction.hpp>
#include <apsis/model/grid_sums.hpp>
#include <apsis/model/nearby_maxwellian.hpp>
#include <apsis/model/velocity_support.hpp>
#include <apsis/velocity/velocity_line_registry.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace apsis {
namespace {

int velocity_dimensions_of(const model_config& config) {
  const int given = static_cast<int>(config.parameters.at("velocity_dimensions"));
  if (config.velocity.rings > 0) {
    if (given == 0 || given == 3) return 3;
    throw input_error(
        fmt::format("model.velocity_dimensions = {} with rings about an axis (they resolve 3); give 3 or "
                    "leave it out",
                    given));
  }
  if (given == 0) return config.space_dimensions;
  if (given < config.space_dimensions)
    throw input_error(
        fmt::format("model.velocity_dimensions = {} is below the {} space dimensions (molecules move along "
                    "all of them); give at least {}",
                    given, config.space_dimensions, config.space_dimensions));
  return given;
}

int degrees_of(const model_config& config, int dimensions) {
  const int given = static_cast<int>(config.parameters.at("degrees_of_freedom"));
  if (given == 0) return dimensions;
  if (given < dimensions)
    throw input_error(
        fmt::format("model.degrees_of_freedom = {} is below model.velocity_dimensions = {} (the grid "
                    "resolves more than there are); give at least {}",
                    given, dimensions, dimensions));
  return given;
}

scalar::variances variances_on(const velocity_line& line, double u) {
  if (line.uniform()) return scalar::variances_at(line.v().data(), line.points(), line.spacing(), u);
  return scalar::variances_at(line.v().data(), line.points(), u);
}

/// On rings, components are (x, r, θ) in the plane (x, r), and (r, θ, x) if the flow depends on r alone. The
/// component along the axis is x.
velocity_grid make_grid(const model_config& config) {
  const velocity_config& of = config.velocity;
  const int dimensions = velocity_dimensions_of(config);
  if (of.rings == 0) return velocity_grid(make_lines(of, dimensions));
  if (config.space_dimensions > 2)
    throw input_error(fmt::format(
        "axisymmetric flow in {} space dimensions (its coordinates are x and r, or r alone); give one or two",
        config.space_dimensions));
  const velocity_line axial = make_lines(of, 1).front();
  const double across = of.max_across > 0.0 ? of.max_across : axial.max();
  return {axial, polar_rings(of.rings, of.angles, across), config.space_dimensions == 1 ? 2 : 0};
}

velocity_set points_of(const velocity_grid& grid, int sets) {
  if (sets == 1) return grid.set();
  std::vector<aligned_vector<double>> coordinates;
  for (int k = 0; k < grid.dimensions(); ++k)
    coordinates.emplace_back(grid.component(k).begin(), grid.component(k).end());
  return {std::move(coordinates), {grid.set().weights().begin(), grid.set().weights().end()}, sets};
}

}  // namespace

gas::gas(const model_config& config)
    : grid_(make_grid(config)),
      degrees_(degrees_of(config, grid_.dimensions())),
      choice_(config.velocity.equilibrium),
      velocities_(points_of(grid_, reduced() ? 2 : 1)) {}

std::vector<model_parameter> gas::parameters() {
  return {
      {.name = "velocity_dimensions",
       .value = 0.0,
       .lowest = 0.0,
       .highest = 3.0,
       .doc = "number of velocity dimensions, 0: as many as space dimensions",
       .integer = true,
       .of_space = true},
      {.name = "degrees_of_freedom",
       .value = 0.0,
       .lowest = 0.0,
       .highest = 1000.0,
       .doc =
           "degrees of freedom D of a molecule, 3 of a monatomic gas in space; the ratio of specific heats "
           "is (D + 2)/D. 0: as many as velocity dimensions. Those that the velocity grid does not resolve "
           "are a second set of unknowns (Chu's reduction)",
       .integer = true}};
}

void gas::moments(const double* row, std::ptrdiff_t pitch, int rows, double* omega) const {
  kinetic_moments(grid_, row, pitch, rows, omega);
  if (!reduced()) return;
  for (int p = 0; p < rows; ++p)
    omega[p * moment_count() + dimensions() + 1] += 0.5 * kinetic_mass(grid_, row + p * pitch + grid_.size());
}

fluid_state gas::state(const double* omega) const {
  if (!reduced()) return to_fluid_state(omega, dimensions());
  return scalar::reduced_gas{dimensions(), degrees_}.state(omega);
}

double gas::moments_of_g(const double* omega, double* of_g) const {
  const int d = dimensions();
  const fluid_state s = state(omega);
  std::copy_n(omega, d + 1, of_g);
  if (grid_.is_polar()) {
    double square = 0.0;
    for (int k = 0; k < d; ++k) square += s.u[k] * s.u[k];
    of_g[d + 1] = omega[0] > 0.0 ? 0.5 * s.rho * (square + d * s.T) : omega[d + 1];
    return omega[0] > 0.0 ? (degrees_ - d) * s.T : 0.0;
  }
  const auto parts = scalar::reduced_gas{d, degrees_}.parts(
      omega, s, [&](int k) { return variances_on(grid_.line(k), s.u[k]); });
  of_g[d + 1] = parts.of_g;
  return parts.others;
}

void gas::fill_h(double energy, double* row) const {
  grid_sums::scale(energy, row, grid_.size(), row + grid_.size());
}

/// Whether the equilibrium is the formula. By default it is the formula only if its moments are exact. Errors
/// of the moments would have one sign and add up from step to step.
template <class State>
bool gas::keeps_formula(const State& state) const {
  return choice_ == equilibrium_choice::formula ||
         (choice_ == equilibrium_choice::automatic && formula_has_exact_moments(grid_, state));
}

/// The equilibrium exists for the moments of every g ≥ 0. Where the formula is undefined (empty space, T = 0
/// up to rounding) it is the discrete Maxwellian.
bool gas::equilibrium_of_g(const double* of_g, double* g, line_moments* of_row) const {
  const fluid_state s = to_fluid_state(of_g, dimensions());
  if (!s.admissible() || !keeps_formula(s)) return discrete_maxwellian(grid_, of_g, g, of_row);
  formula_maxwellian(grid_, s, g);
  if (of_row != nullptr && formula_has_exact_moments(grid_, s)) of_row->set_gaussian(s.T);
  return true;
}

int gas::equilibria_of_g(const double* of_g, int rows, double* g, std::ptrdiff_t pitch) const {
  if (dimensions() == 1) return equilibria_on_line(of_g, rows, g, pitch);
  std::array<row_of_state, most_line_states> by_newton;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  for (int first = 0; first < rows; first += most_line_states) {
    const int some = std::min(most_line_states, rows - first);
    std::size_t count = 0;
    std::array<int, most_line_states> places{};
    int without = some;  // first row without an equilibrium
    for (int p = 0; p < some && without == some; ++p) {
      const double* of = of_g + (first + p) * moment_count();
      double* to = g + (first + p) * pitch;
      const fluid_state s = to_fluid_state(of, dimensions());
      if (!s.admissible() || grid_.is_polar() || keeps_formula(s)) {
        if (!equilibrium_of_g(of, to)) without = p;
      } else {
        places[count] = p;
        by_newton[count++] = {of, s, to};
      }
    }
    const int found = discrete_maxwellians(grid_, {by_newton.data(), count});
    if (found < static_cast<int>(count)) without = std::min(without, places[static_cast<std::size_t>(found)]);
    if (without < some) return first + without;
  }
  return rows;
}

int gas::equilibria_on_line(const double* of_g, int rows, double* g, std::ptrdiff_t pitch) const {
  std::array<line_state, most_line_states> states;       // NOLINT(cppcoreguidelines-pro-type-member-init)
  std::array<row_of_state, most_line_states> by_newton;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  for (int first = 0; first < rows;) {
    const int some = std::min(most_line_states, rows - first);
    const double* of = of_g + first * 3;
    double* to = g + first * pitch;
    const int admissible = formula_maxwellians_on_line(grid_, of, some, to, pitch, states.data());
    std::size_t count = 0;
    std::array<int, most_line_states> places{};
    for (int p = 0; p < admissible; ++p) {
      const line_state& state = states[static_cast<std::size_t>(p)];
      if (keeps_formula(state)) continue;
      places[count] = p;
      by_newton[count++] = {of + p * 3, {state.rho, {state.u, 0.0, 0.0}, state.T}, to + p * pitch};
    }
    const int found = discrete_maxwellians(grid_, {by_newton.data(), count});
    if (found < static_cast<int>(count)) return first + places[static_cast<std::size_t>(found)];
    first += admissible;
    if (admissible == some) continue;
    if (!equilibrium_of_g(of_g + first * 3, g + first * pitch)) return first;
    ++first;
  }
  return rows;
}

bool gas::equilibrium(const double* omega, double* row) const {
  return equilibria(omega, 1, row, 0) == 1;
}

bool gas::equilibrium(const double* omega, double* row, line_moments& of_row) const {
  of_row.known = false;
  if (!reduced()) return equilibrium_of_g(omega, row, &of_row);
  std::array<double, most_moments> of_g;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  of_row.others = moments_of_g(omega, of_g.data());
  if (std::isnan(of_row.others) || !equilibrium_of_g(of_g.data(), row, &of_row)) return false;
  fill_h(of_row.others, row);
  return true;
}

int gas::equilibria(const double* omega, int rows, double* row, std::ptrdiff_t pitch) const {
  if (!reduced()) return equilibria_of_g(omega, rows, row, pitch);
  std::array<double, static_cast<std::size_t>(most_line_states) * most_moments> of_g;  // NOLINT
  std::array<double, most_line_states> of_h;                                           // NOLINT
  const int count = moment_count();
  for (int first = 0; first < rows; first += most_line_states) {
    const int some = std::min(most_line_states, rows - first);
    const double* of = omega + first * count;
    double* to = row + first * pitch;
    int possible = 0;
    for (; possible < some; ++possible) {
      const double energy = moments_of_g(of + possible * count, of_g.data() + possible * count);
      if (std::isnan(energy)) break;
      of_h[static_cast<std::size_t>(possible)] = energy;
    }
    const int found = equilibria_of_g(of_g.data(), possible, to, pitch);
    for (int p = 0; p < found; ++p) fill_h(of_h[static_cast<std::size_t>(p)], to + p * pitch);
    if (found < some) return first + found;
  }
  return rows;
}

std::string gas::why_inadmissible(const double* omega) const {
  if (!reduced()) return why_unrealizable(grid_, omega);
  double of_g[most_moments];
  moments_of_g(omega, of_g);
  return why_unrealizable(grid_, of_g);
}

void gas::formula(const fluid_state& state, double weight, double* row) const {
  formula_maxwellian(grid_, state, row);
  for (int j = 0; j < grid_.size(); ++j) row[j] *= weight;
  if (!reduced()) return;
  const double factor = (degrees_ - dimensions()) * state.T;
  for (int j = 0; j < grid_.size(); ++j) row[grid_.size() + j] = factor * row[j];
}

double gas::entropy(const double* row) const {
  const double* weights = grid_.uniform() ? nullptr : grid_.set().weights().data();
  const double* h = reduced() ? row + grid_.size() : nullptr;
  return grid_.weight() * grid_sums::entropy(weights, row, h, 0.5 * (degrees_ - dimensions()), grid_.size());
}

/// The moments of g need one addition and two multiply–adds per point on a line. In a product of lines they
/// need one multiply–add for each of d + 1 functions of the lines. M needs two multiplications per point on a
/// line (without the first vector), or one per point of a product. Moments and equilibrium of h need one
/// operation each.
double gas::operations() const {
  const bool on_a_line = dimensions() == 1;
  const double of_g = on_a_line ? 3.0 + 2.0 : dimensions() + 1.0 + 1.0, of_h = 2.0;
  return reduced() ? 0.5 * (of_g + of_h) : of_g;
}

unsupported_initial_data gas::check_supported(const double* row) const {
  double omega[most_moments];
  moments(row, 0, 1, omega);
  const fluid_state s = state(omega);
  if (!s.admissible())
    return {"model.initial",
            fmt::format("the initial data have no Maxwellian (density {:.6g}, temperature {:.6g}); "
                        "change them",
                        s.rho, s.T)};
  const velocity_fit fit = velocity_support(*this).fit(s);
  if (!(fit.missed > velocity_limits::bad)) return {};
  return velocity_problem(*this, s, fit, {.subject = "the data"});
}

std::string gas::row_of(std::span<const double> given, std::span<double> row) const {
  const auto d = static_cast<std::size_t>(dimensions());
  const double rho = given[0], T = given[d + 1];
  if (!(rho > 0.0)) return fmt::format("density {:.6g} is not positive", rho);
  if (!(T > 0.0)) return fmt::format("temperature {:.6g} is not positive", T);
  double omega[most_moments];
  double square = 0.0;
  omega[0] = rho;
  for (std::size_t k = 1; k <= d; ++k) {
    omega[k] = rho * given[k];
    square += given[k] * given[k];
  }
  omega[d + 1] = 0.5 * rho * (square + degrees_ * T);
  return equilibrium(omega, row.data()) ? "" : why_inadmissible(omega);
}

data_form gas::maxwellian_form() const {
  return {"Maxwellian",
          {{"rho", "density > 0 (dimensionless)", 1, {}, dimensions::density},
           {"u", "bulk velocity (dimensionless)", dimensions(), 0.0, dimensions::velocity},
           {"T", "temperature > 0 (dimensionless)", 1, {}, dimensions::temperature}},
          [this](std::span<const double> given, std::span<double> row) { return row_of(given, row); }};
}

data_form gas::distribution_form() const {
  const auto function = [](const char* name, const char* doc) {
    return data_variable{.name = name, .doc = doc, .of_velocity = true};
  };
  data_form form;
  form.description = "distribution";
  if (reduced())
    form.variables = {function("g",
                               "integral of f over the velocities eta that the grid does not resolve, a "
                               "formula in the position and v_x, v_y, v_z"),
                      function("h", "integral of |eta|^2 f")};
  else
    form.variables = {function("f", "formula in the position and v_x, v_y, v_z (dimensionless)")};
  form.row = [this](std::span<const double> given, std::span<double> row) {
    std::copy(given.begin(), given.end(), row.begin());
    double omega[most_moments];
    moments(row.data(), 0, 1, omega);
    const fluid_state s = state(omega);
    if (s.admissible()) return std::string();
    return s.rho > 0.0 ? fmt::format("temperature {:.6g} is not positive", s.T)
                       : fmt::format("density {:.6g} is not positive", s.rho);
  };
  return form;
}

}  // namespace apsis
