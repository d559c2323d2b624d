#include <apsis/model/maxwellian.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/model/formulas/velocity_grid.hpp>
#include <apsis/model/grid_sums.hpp>
#include <apsis/model/polar_maxwellian.hpp>
#include <apsis/model/tensor_product.hpp>
#include <apsis/model/velocity_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Computes all three moments of one velocity dimension in one pass.
void moments_on_line(const velocity_grid& grid, const double* f, std::ptrdiff_t pitch, int rows,
                     double* omega) {
  constexpr int most = most_line_states;
  std::array<velocity_rows::sums, most> sums;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  for (int first = 0; first < rows; first += most) {
    const int some = std::min(most, rows - first);
    velocity_rows::moments(f + first * pitch, pitch, some, grid.last_line().v().data(),
                           grid.half_square().data(), grid.size(), sums.data());
    for (int r = 0; r < some; ++r, omega += 3) {
      const auto& sum = sums[static_cast<std::size_t>(r)];
      omega[0] = grid.weight() * sum.mass;
      omega[1] = grid.weight() * sum.momentum;
      omega[2] = grid.weight() * sum.energy;
    }
  }
}

}  // namespace

grid_sums::axis last_axis(const velocity_grid& grid) {
  return {grid.last_line().points(), grid.last_line().v().data(), grid.weights_of_last()};
}

void kinetic_moments(const velocity_grid& grid, const double* f, std::ptrdiff_t pitch, int rows,
                     double* omega) {
  if (grid.dimensions() == 1 && grid.uniform()) return moments_on_line(grid, f, pitch, rows, omega);
  for (int r = 0; r < rows; ++r) kinetic_moments(grid, f + r * pitch, omega + r * (grid.dimensions() + 2));
}

void kinetic_moments(const velocity_grid& grid, const double* f, double* omega) {
  if (grid.dimensions() == 1 && grid.uniform()) return moments_on_line(grid, f, 0, 1, omega);
  const int d = grid.dimensions(), functions = d > 1 ? d + 1 : 1;
  std::array<grid_sums::powers, 4> sums;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  grid_sums::sum(last_axis(grid), grid.lines(), f, 0.0, grid.functions_of_lines().data(), functions,
                 sums.data());
  omega[0] = grid.weight() * sums[0][0];
  for (int k = 0; k + 1 < d; ++k)
    omega[1 + grid.component_across(k)] = grid.weight() * sums[static_cast<std::size_t>(k) + 1][0];
  omega[1 + grid.last_component()] = grid.weight() * sums[0][1];
  omega[d + 1] =
      grid.weight() * scalar::energy_of_grid(sums[0][2], d > 1 ? sums[static_cast<std::size_t>(d)][0] : 0.0);
}

double kinetic_mass(const velocity_grid& grid, const double* f) {
  grid_sums::powers sums;
  grid_sums::sum(last_axis(grid), grid.lines(), f, 0.0, grid.functions_of_lines().data(), 1, &sums);
  return grid.weight() * sums[0];
}

namespace {

/// Returns scratch memory of this thread for the three directions.
std::array<aligned_vector<double>, 3>& line_buffers(const velocity_grid& grid) {
  thread_local std::array<aligned_vector<double>, 3> lines;
  for (int k = 0; k < grid.dimensions(); ++k)
    lines[static_cast<std::size_t>(k)].resize(static_cast<std::size_t>(grid.line(k).points()));
  return lines;
}

void gaussian_on(const velocity_line& line, const velocity_rows::gaussian& of, double* m) {
  gaussians_on(line, &of, 1, m, 0);
}

}  // namespace

void tensor_product(const velocity_grid& grid, double factor, const std::array<const double*, 3>& g,
                    double* m) {
  scalar::functions_of_directions of{grid.dimensions(), {}, {}};
  for (int k = 0; k < of.dimensions; ++k) {
    of.n[k] = grid.line(k).points();
    of.g[k] = g[static_cast<std::size_t>(k)];
  }
  thread_local aligned_vector<double> of_lines;
  of_lines.resize(static_cast<std::size_t>(grid.lines()));
  double* const to = of_lines.data();
  scalar::multiply_across_lines(of, factor, [to](int line, double product) { to[line] = product; });
  grid_sums::multiply(to, grid.lines(), of.g[of.dimensions - 1], of.n[of.dimensions - 1], m);
}

void gaussians_on(const velocity_line& line, const velocity_rows::gaussian* of_rows, int rows, double* m,
                  std::ptrdiff_t pitch) {
  if (line.uniform())
    return velocity_rows::gaussians({line.points(), line.spacing()}, of_rows, rows, m, pitch);
  for (int p = 0; p < rows; ++p)
    velocity_rows::gaussian_at(line.v().data(), line.points(), of_rows[p], m + p * pitch);
}

void formula_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m) {
  if (grid.is_polar()) return formula_maxwellian_on_rings(grid, state, m);
  const double factor = state.height(grid.dimensions());
  if (grid.dimensions() == 1) return gaussian_on(grid.line(0), {factor, state.u[0], state.T}, m);
  auto& lines = line_buffers(grid);
  std::array<const double*, 3> g{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(grid.dimensions()); ++k) {
    gaussian_on(grid.line(static_cast<int>(k)), {1.0, state.u[k], state.T}, lines[k].data());
    g[k] = lines[k].data();
  }
  tensor_product(grid, factor, g, m);
}

int formula_maxwellians_on_line(const velocity_grid& grid, const double* omega, int rows, double* m,
                                std::ptrdiff_t pitch, line_state* states) {
  std::array<velocity_rows::gaussian, most_line_states>
      curves;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  // No early exit, so that the compiler can vectorize the divisions and roots.
#pragma omp simd
  for (int p = 0; p < rows; ++p) {
    const auto of = scalar::state_of_line::of(omega[3 * p], omega[3 * p + 1], omega[3 * p + 2]);
    states[p] = {of.rho, of.u, of.T};
    curves[static_cast<std::size_t>(p)] = {of.height(), of.u, of.T};
  }
  int admissible = 0;
  while (admissible < rows && states[admissible].admissible()) ++admissible;
  gaussians_on(grid.last_line(), curves.data(), admissible, m, pitch);
  return admissible;
}

namespace {

bool has_exact_moments(const velocity_line& line, const line_state& state) {
  return line.uniform() &&
         scalar::gaussian_has_exact_moments(line.spacing(), line.max(), {state.rho, state.u, state.T});
}

}  // namespace

bool formula_has_exact_moments(const velocity_grid& grid, const line_state& state) {
  return has_exact_moments(grid.last_line(), state);
}

bool formula_has_exact_moments(const velocity_grid& grid, const fluid_state& state) {
  if (grid.is_polar()) return false;
  for (int k = 0; k < grid.dimensions(); ++k)
    if (!has_exact_moments(grid.line(k), {state.rho, state.u[k], state.T})) return false;
  return true;
}

double moment_defect(const velocity_grid& grid, const double* m, const double* omega,
                     const fluid_state& state) {
  std::array<double, 5> own{};
  kinetic_moments(grid, m, own.data());
  const int d = grid.dimensions();
  double defect = std::abs(own[0] - omega[0]) / state.rho;
  for (int k = 0; k < d; ++k)
    defect = std::max(defect, std::abs(own[static_cast<std::size_t>(k) + 1] - omega[1 + k]) /
                                  (state.rho * (std::sqrt(state.T) + std::abs(state.u[k]))));
  return std::max(defect, std::abs(own[static_cast<std::size_t>(d) + 1] - omega[1 + d]) / omega[1 + d]);
}

}  // namespace apsis
