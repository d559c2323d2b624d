#include <apsis/model/maxwellian.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/model/tensor_product.hpp>
#include <apsis/model/velocity_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace apsis {

velocity_grid::velocity_grid(int dimensions, int points, double max)
    : dimensions_(dimensions), points_(points), max_(max), spacing_(2.0 * max / points) {
  if (dimensions < 1 || dimensions > 3)
    throw input_error(fmt::format("{} velocity dimensions (not 1, 2 or 3); give 1, 2 or 3", dimensions));
  if (points < 4)
    throw input_error(fmt::format("{} velocity points (too few for three moments); give at least 4", points));
  const double velocities = std::pow(points, dimensions);
  if (velocities > most_velocities)
    throw input_error(fmt::format(
        "velocity.points = {} are {:.4g} velocities in {} dimension{} (more than {} cannot be numbered); "
        "give at most {}",
        points, velocities, dimensions, dimensions == 1 ? "" : "s", most_velocities,
        static_cast<int>(std::floor(std::pow(most_velocities, 1.0 / dimensions) * (1.0 + 1e-12)))));
  if (!(max > 0.0) || !std::isfinite(max))
    throw input_error("velocity.max cannot be used (it is not positive and finite); give max > 0");
  const auto n = static_cast<std::size_t>(points);
  for (std::size_t i = 0; i < n; ++i) {
    // Symmetric by construction: v_{N−1−i} = −v_i exactly, so that even data keep u = 0 to round-off.
    line_.push_back(0.5 * spacing_ * (2.0 * static_cast<double>(i) + 1.0 - points));
    line_half_square_.push_back(0.5 * line_.back() * line_.back());
  }
  for (int k = 0; k < dimensions; ++k) size_ *= points;
  weight_ = std::pow(spacing_, dimensions);
  const auto total = static_cast<std::size_t>(size_);
  std::vector<aligned_vector<double>> components(static_cast<std::size_t>(dimensions),
                                                 aligned_vector<double>(total));
  half_square_.assign(total, 0.0);
  for (std::size_t j = 0; j < total; ++j) {
    std::size_t rest = j;
    for (int k = dimensions - 1; k >= 0; --k) {
      const double v = line_[rest % n];
      components[static_cast<std::size_t>(k)][j] = v;
      half_square_[j] += 0.5 * v * v;
      rest /= n;
    }
  }
  set_ = velocity_set(std::move(components), std::vector<double>(total, weight_));
}

namespace {

/// One velocity dimension: all three in one pass.
void moments_on_line(const velocity_grid& grid, const double* f, std::ptrdiff_t pitch, int rows,
                     double* omega) {
  constexpr int most = most_line_states;
  std::array<velocity_rows::sums, most> sums;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  for (int first = 0; first < rows; first += most) {
    const int some = std::min(most, rows - first);
    velocity_rows::moments(f + first * pitch, pitch, some, grid.line().data(), grid.half_square().data(),
                           grid.size(), sums.data());
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
  if (grid.dimensions() == 1) return moments_on_line(grid, f, pitch, rows, omega);
  for (int r = 0; r < rows; ++r) kinetic_moments(grid, f + r * pitch, omega + r * (grid.dimensions() + 2));
}

namespace {

/// Sums over some lines of the last direction, without the factor Δv^d.
struct line_sums {
  double mass = 0.0, energy = 0.0;
  std::array<double, 3> momentum{};

  void add(const line_sums& other) {
    mass += other.mass;
    energy += other.energy;
    for (std::size_t k = 0; k < 3; ++k) momentum[k] += other.momentum[k];
  }
};

/// Adds halves of halves: of a Gaussian, most terms lie far out, and added one by one to a sum that is
/// already large they would all be rounded away, which is a loss of the same sign in every cell and step.
line_sums sum_over_lines(const velocity_grid& grid, const double* f, int first, int lines) {
  constexpr int few = 16;
  line_sums sum;
  if (lines > few) {
    const int half = lines / 2;
    sum = sum_over_lines(grid, f, first, half);
    sum.add(sum_over_lines(grid, f, first + half, lines - half));
    return sum;
  }
  const std::ptrdiff_t n = grid.points(), from = n * first;
  std::array<velocity_rows::sums, few> rows;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  velocity_rows::moments(f + from, n, lines, grid.line().data(), grid.line_half_square().data(),
                         grid.points(), rows.data());
  const auto outer = static_cast<std::size_t>(grid.dimensions()) - 1;
  for (int i = 0; i < lines; ++i) {
    const auto& row = rows[static_cast<std::size_t>(i)];
    double half_square = 0.0;
    for (std::size_t k = 0; k < outer; ++k) {
      const double v = grid.component(static_cast<int>(k))[static_cast<std::size_t>(from + i * n)];
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
  if (d == 1) return moments_on_line(grid, f, 0, 1, omega);
  const line_sums sum = sum_over_lines(grid, f, 0, grid.size() / grid.points());
  omega[0] = grid.weight() * sum.mass;
  for (int k = 0; k < d; ++k) omega[1 + k] = grid.weight() * sum.momentum[static_cast<std::size_t>(k)];
  omega[1 + d] = grid.weight() * sum.energy;
}

namespace {

/// Per-thread scratch for the three directions.
std::array<aligned_vector<double>, 3>& line_buffers(int points) {
  thread_local std::array<aligned_vector<double>, 3> lines;
  for (auto& line : lines) line.resize(static_cast<std::size_t>(points));
  return lines;
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
  const int n = grid.points();
  const auto scaled = [n](double scale, const double* line, double* to) {
    for (int j = 0; j < n; ++j) to[j] = scale * line[j];
  };
  if (grid.dimensions() == 1) return scaled(factor, g[0], m);
  for (int i = 0; i < n; ++i) {
    const double of_first = factor * g[0][i];
    if (grid.dimensions() == 2) {
      scaled(of_first, g[1], m);
      m += n;
    } else {
      for (int k = 0; k < n; ++k, m += n) scaled(of_first * g[1][k], g[2], m);
    }
  }
}

void formula_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m) {
  const velocity_rows::points points{grid.points(), grid.spacing()};
  const double factor = height(state, grid.dimensions());
  if (grid.dimensions() == 1) {
    const velocity_rows::gaussian row{factor, state.u[0], state.T};
    return velocity_rows::gaussians(points, &row, 1, m, 0);
  }
  auto& lines = line_buffers(grid.points());
  std::array<const double*, 3> g{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(grid.dimensions()); ++k) {
    const velocity_rows::gaussian of_line{1.0, state.u[k], state.T};
    velocity_rows::gaussians(points, &of_line, 1, lines[k].data(), 0);
    g[k] = lines[k].data();
  }
  tensor_product(grid, factor, g, m);
}

int formula_maxwellians_on_line(const velocity_grid& grid, const double* omega, int rows, double* m,
                                std::ptrdiff_t pitch, line_state* states) {
  std::array<velocity_rows::gaussian, most_line_states>
      curves;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  int admissible = 0;
  for (; admissible < rows; ++admissible, omega += 3) {
    line_state& s = states[admissible];
    s.rho = omega[0];
    s.u = omega[1] / s.rho;
    s.T = 2.0 * omega[2] / s.rho - s.u * s.u;
    curves[static_cast<std::size_t>(admissible)] = {s.rho * (1.0 / std::sqrt(2.0 * std::numbers::pi * s.T)),
                                                    s.u, s.T};
    if (!s.admissible()) break;
  }
  velocity_rows::gaussians({grid.points(), grid.spacing()}, curves.data(), admissible, m, pitch);
  return admissible;
}

bool formula_has_exact_moments(const velocity_grid& grid, const line_state& state) {
  constexpr double dense = 1e-250;  // values below 1e-300, which are set to 0, are below its rounding
  constexpr double enough = 40.0;   // 100 e^−40 is below the rounding of a sum
  constexpr double spacings = enough / (2.0 * std::numbers::pi * std::numbers::pi);
  const double room = grid.max() - std::abs(state.u);
  return state.rho >= dense && state.T >= spacings * grid.spacing() * grid.spacing() && room > 0.0 &&
         room * room >= 2.0 * enough * state.T;
}

bool formula_has_exact_moments(const velocity_grid& grid, const fluid_state& state) {
  for (int k = 0; k < grid.dimensions(); ++k)
    if (!formula_has_exact_moments(grid, line_state{state.rho, state.u[k], state.T})) return false;
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
