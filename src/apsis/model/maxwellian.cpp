#include <apsis/model/maxwellian.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/model/tensor_product.hpp>
#include <apsis/model/velocity_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// One velocity dimension: all three in one pass.
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

void kinetic_moments(const velocity_grid& grid, const double* f, std::ptrdiff_t pitch, int rows,
                     double* omega) {
  if (grid.dimensions() == 1 && grid.uniform()) return moments_on_line(grid, f, pitch, rows, omega);
  for (int r = 0; r < rows; ++r) kinetic_moments(grid, f + r * pitch, omega + r * (grid.dimensions() + 2));
}

namespace {

/// Sums over some lines of the last direction, without the factor Δv^d.
struct line_moments {
  double mass = 0.0, energy = 0.0;
  std::array<double, 3> momentum{};

  void add(const line_moments& other) {
    mass += other.mass;
    energy += other.energy;
    for (std::size_t k = 0; k < 3; ++k) momentum[k] += other.momentum[k];
  }
};

/// Adds halves of halves: of a Gaussian, most terms lie far out, and added one by one to a sum that is
/// already large they would all be rounded away, which is a loss of the same sign in every cell and step.
line_moments sum_over_lines(const velocity_grid& grid, const double* f, int first, int lines) {
  constexpr int few = 16;
  line_moments sum;
  if (lines > few) {
    const int half = lines / 2;
    sum = sum_over_lines(grid, f, first, half);
    sum.add(sum_over_lines(grid, f, first + half, lines - half));
    return sum;
  }
  const velocity_line& line = grid.last_line();
  const std::ptrdiff_t n = line.points(), from = n * first;
  std::array<velocity_rows::sums, few> rows;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  velocity_rows::moments(f + from, n, lines, line.v().data(), line.half_square().data(), line.points(),
                         rows.data());
  const auto outer = static_cast<std::size_t>(grid.dimensions()) - 1;
  for (int i = 0; i < lines; ++i) {
    const auto& row = rows[static_cast<std::size_t>(i)];
    double half_square = 0.0;
    for (std::size_t k = 0; k < outer; ++k) {
      const double v = grid.component_of_lines(static_cast<int>(k))[first + i];
      sum.momentum[k] += v * row.mass;
      half_square += 0.5 * v * v;
    }
    sum.mass += row.mass;
    sum.momentum[outer] += row.momentum;
    sum.energy += row.energy + half_square * row.mass;
  }
  return sum;
}

}  // namespace

void kinetic_moments(const velocity_grid& grid, const double* f, double* omega) {
  const int d = grid.dimensions();
  thread_local aligned_vector<double> scratch;
  const double* row = grid.weighted(f, scratch);
  if (d == 1) return moments_on_line(grid, row, 0, 1, omega);
  const line_moments sum = sum_over_lines(grid, row, 0, grid.lines());
  omega[0] = grid.weight() * sum.mass;
  for (int k = 0; k < d; ++k) omega[1 + k] = grid.weight() * sum.momentum[static_cast<std::size_t>(k)];
  omega[1 + d] = grid.weight() * sum.energy;
}

namespace {

/// Per-thread scratch for the three directions.
std::array<aligned_vector<double>, 3>& line_buffers(const velocity_grid& grid) {
  thread_local std::array<aligned_vector<double>, 3> lines;
  for (int k = 0; k < grid.dimensions(); ++k)
    lines[static_cast<std::size_t>(k)].resize(static_cast<std::size_t>(grid.line(k).points()));
  return lines;
}

void gaussian_on(const velocity_line& line, const velocity_rows::gaussian& of, double* m) {
  gaussians_on(line, &of, 1, m, 0);
}

/// ρ (2πT)^{−d/2}.
double height(const fluid_state& state, int dimensions) {
  const double of_one_direction = 1.0 / std::sqrt(2.0 * std::numbers::pi * state.T);
  double factor = state.rho;
  for (int k = 0; k < dimensions; ++k) factor *= of_one_direction;
  return factor;
}

}  // namespace

void tensor_product(const velocity_grid& grid, double factor, const std::array<const double*, 3>& g,
                    double* m) {
  const int n = grid.last_line().points();
  const auto scaled = [n](double scale, const double* line, double* to) {
    for (int j = 0; j < n; ++j) to[j] = scale * line[j];
  };
  if (grid.dimensions() == 1) return scaled(factor, g[0], m);
  for (int i = 0; i < grid.line(0).points(); ++i) {
    const double of_first = factor * g[0][i];
    if (grid.dimensions() == 2) {
      scaled(of_first, g[1], m);
      m += n;
    } else {
      for (int k = 0; k < grid.line(1).points(); ++k, m += n) scaled(of_first * g[1][k], g[2], m);
    }
  }
}

void gaussians_on(const velocity_line& line, const velocity_rows::gaussian* of_rows, int rows, double* m,
                  std::ptrdiff_t pitch) {
  if (line.uniform())
    return velocity_rows::gaussians({line.points(), line.spacing()}, of_rows, rows, m, pitch);
  for (int p = 0; p < rows; ++p)
    for (std::size_t j = 0; j < line.v().size(); ++j) {
      const double c = line.v()[j] - of_rows[p].u,
                   value = of_rows[p].a * std::exp(-c * c / (2.0 * of_rows[p].T));
      m[p * pitch + static_cast<std::ptrdiff_t>(j)] = value > 1e-300 ? value : 0.0;
    }
}

void formula_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m) {
  const double factor = height(state, grid.dimensions());
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
    const double rho = omega[3 * p], u = omega[3 * p + 1] / rho;
    const double T = 2.0 * omega[3 * p + 2] / rho - u * u;
    states[p] = {rho, u, T};
    curves[static_cast<std::size_t>(p)] = {rho * (1.0 / std::sqrt(2.0 * std::numbers::pi * T)), u, T};
  }
  int admissible = 0;
  while (admissible < rows && states[admissible].admissible()) ++admissible;
  gaussians_on(grid.last_line(), curves.data(), admissible, m, pitch);
  return admissible;
}

namespace {

bool has_exact_moments(const velocity_line& line, const line_state& state) {
  constexpr double dense = 1e-250;  // values below 1e-300, which are set to 0, are below its rounding
  constexpr double enough = 40.0;   // 100 e^−40 is below the rounding of a sum
  constexpr double spacings = enough / (2.0 * std::numbers::pi * std::numbers::pi);
  const double room = line.max() - std::abs(state.u);
  return line.uniform() && state.rho >= dense && state.T >= spacings * line.spacing() * line.spacing() &&
         room > 0.0 && room * room >= 2.0 * enough * state.T;
}

}  // namespace

bool formula_has_exact_moments(const velocity_grid& grid, const line_state& state) {
  return has_exact_moments(grid.last_line(), state);
}

bool formula_has_exact_moments(const velocity_grid& grid, const fluid_state& state) {
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
