#include <apsis/model/maxwellian.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/model/vector_math.hpp>
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
    throw input_error(fmt::format("{} velocity dimensions (1, 2 or 3 exist)", dimensions));
  if (points < 4)
    throw input_error(fmt::format("{} velocity points (too few for three moments); give at least 4", points));
  const double velocities = std::pow(points, dimensions);
  if (velocities > most_velocities)
    throw input_error(fmt::format(
        "velocity.points = {} are {:.4g} velocities in {} dimension{} (more than {} cannot be numbered); "
        "give at "
        "most {}",
        points, velocities, dimensions, dimensions == 1 ? "" : "s", most_velocities,
        static_cast<int>(std::floor(std::pow(most_velocities, 1.0 / dimensions) * (1.0 + 1e-12)))));
  if (!(max > 0.0) || !std::isfinite(max))
    throw input_error("velocity.max is not positive and finite; give max > 0");
  const auto n = static_cast<std::size_t>(points);
  for (std::size_t i = 0; i < n; ++i) {
    // Symmetric by construction: v_{N−1−i} = −v_i exactly, so that even data keep u = 0 to round-off.
    line_.push_back(0.5 * spacing_ * (2.0 * static_cast<double>(i) + 1.0 - points));
    line_half_square_.push_back(0.5 * line_.back() * line_.back());
  }
  for (int k = 0; k < dimensions; ++k) size_ *= points;
  weight_ = std::pow(spacing_, dimensions);
  const auto total = static_cast<std::size_t>(size_);
  components_.assign(static_cast<std::size_t>(dimensions), aligned_vector<double>(total));
  half_square_.assign(total, 0.0);
  for (std::size_t j = 0; j < total; ++j) {
    std::size_t rest = j;
    for (int k = dimensions - 1; k >= 0; --k) {
      const double v = line_[rest % n];
      components_[static_cast<std::size_t>(k)][j] = v;
      half_square_[j] += 0.5 * v * v;
      rest /= n;
    }
  }
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

/// exp(beta x_j + gamma x_j²) of x = (v − u)/scale for one direction. What would leave the range of normal
/// numbers becomes 0. Whole packets only: the last elements go through the same instructions as the others.
class line_buffer {
 public:
  explicit line_buffer(int n)
      : padded_((n + packet_length - 1) / packet_length * packet_length),
        exponents_(static_cast<std::size_t>(padded_), 0.0),
        values_(static_cast<std::size_t>(padded_), 0.0) {}

  const double* exponential(const velocity_grid& grid, double u, double scale, double beta, double gamma) {
    constexpr double lowest = -690.0;  // exp is 1e-300
    const double* v = grid.line().data();
    double* exponent = exponents_.data();
    double* value = values_.data();
    const double inverse = 1.0 / scale;
    const int n = grid.points();
#pragma omp simd
    for (int j = 0; j < n; ++j) {
      const double x = (v[j] - u) * inverse;
      exponent[j] = x * (beta + gamma * x);
      value[j] = std::max(exponent[j], lowest);
    }
    exp_packets(value, padded_);
#pragma omp simd
    for (int j = 0; j < n; ++j) value[j] = exponent[j] < lowest ? 0.0 : value[j];
    return value;
  }

  double* values() { return values_.data(); }

 private:
  int padded_;
  aligned_vector<double> exponents_, values_;
};

/// m ← factor Π_k g_k(v_k).
void tensor_product(const velocity_grid& grid, double factor, const std::array<const double*, 3>& g,
                    double* m) {
  const int n = grid.points();
  if (grid.dimensions() == 1) {
    for (int j = 0; j < n; ++j) m[j] = factor * g[0][j];
    return;
  }
  const int outer = grid.size() / n;
  const double* last = g[static_cast<std::size_t>(grid.dimensions()) - 1];
  for (int o = 0; o < outer; ++o) {
    const double scale = grid.dimensions() == 2 ? factor * g[0][o] : factor * g[0][o / n] * g[1][o % n];
    for (int j = 0; j < n; ++j) m[o * n + j] = scale * last[j];
  }
}

/// Per-thread scratch for the three directions.
std::array<line_buffer, 3>& buffers(int points) {
  thread_local int size = 0;
  thread_local std::array<line_buffer, 3> lines = {line_buffer(0), line_buffer(0), line_buffer(0)};
  if (size != points) {
    lines = {line_buffer(points), line_buffer(points), line_buffer(points)};
    size = points;
  }
  return lines;
}

/// Σ_j x_j^k g_j for k = 0 … 4 in one direction, with x = (v − u)/scale.
std::array<double, 5> power_sums(const velocity_grid& grid, const double* g, double u, double scale) {
  std::array<double, 5> s{};
  const double* v = grid.line().data();
  for (int j = 0; j < grid.points(); ++j) {
    const double x = (v[j] - u) / scale;
    double power = g[j];
    for (double& sum : s) {
      sum += power;
      power *= x;
    }
  }
  return s;
}

}  // namespace

namespace {

/// ρ (2πT)^{−d/2}.
double height(const fluid_state& state, int dimensions) {
  const double of_one_direction = 1.0 / std::sqrt(2.0 * std::numbers::pi * state.T);
  double factor = state.rho;
  for (int k = 0; k < dimensions; ++k) factor *= of_one_direction;
  return factor;
}

}  // namespace

void formula_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m) {
  const velocity_rows::points points{grid.points(), grid.spacing()};
  const double factor = height(state, grid.dimensions());
  if (grid.dimensions() == 1) {
    const velocity_rows::gaussian row{factor, state.u[0], state.T};
    return velocity_rows::gaussians(points, &row, 1, m, 0);
  }
  auto& lines = buffers(grid.points());
  std::array<const double*, 3> g{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(grid.dimensions()); ++k) {
    const velocity_rows::gaussian of_line{1.0, state.u[k], state.T};
    velocity_rows::gaussians(points, &of_line, 1, lines[k].values(), 0);
    g[k] = lines[k].values();
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
  constexpr double enough = 40.0;  // 100 e^−40 is below the rounding of a sum
  constexpr double spacings = enough / (2.0 * std::numbers::pi * std::numbers::pi);
  const double room = grid.max() - std::abs(state.u);
  return state.T >= spacings * grid.spacing() * grid.spacing() && room > 0.0 &&
         room * room >= 2.0 * enough * state.T;
}

bool formula_has_exact_moments(const velocity_grid& grid, const fluid_state& state) {
  for (int k = 0; k < grid.dimensions(); ++k)
    if (!formula_has_exact_moments(grid, line_state{state.rho, state.u[k], state.T})) return false;
  return true;
}

namespace {

/// The convex dual of the discrete Maxwellian in ξ = (v − u)/√T: Σ_k log Z_k(β_k, γ) − γ d with
/// Z_k = Σ_j exp(β_k ξ_j + γ ξ_j²). Stationary where ⟨ξ_k⟩ = 0 and ⟨|ξ|²⟩ = d; mass follows by normalisation.
class maxwellian_dual {
 public:
  struct point {
    std::array<double, 3> beta{};
    double gamma = -0.5;
  };
  struct value {
    double objective = 0.0, partition = 1.0;
    std::array<double, 3> mean{};      ///< gradient in β
    double energy = 0.0;               ///< gradient in γ
    std::array<double, 3> variance{};  ///< Hessian: diagonal in β …
    std::array<double, 3> mixed{};     ///< … its last column …
    double energy_variance = 0.0;      ///< … and its corner
    double defect() const {
      return std::max({std::abs(mean[0]), std::abs(mean[1]), std::abs(mean[2]), std::abs(energy)});
    }
  };

  maxwellian_dual(const velocity_grid& grid, const fluid_state& state)
      : grid_(grid), state_(state), scale_(std::sqrt(state.T)) {}

  value evaluate(const point& x) {
    value f;
    f.objective = -x.gamma * grid_.dimensions();
    f.energy = -grid_.dimensions();
    auto& lines = buffers(grid_.points());
    for (std::size_t k = 0; k < static_cast<std::size_t>(grid_.dimensions()); ++k) {
      factors_[k] = lines[k].exponential(grid_, state_.u[k], scale_, x.beta[k], x.gamma);
      const auto s = power_sums(grid_, factors_[k], state_.u[k], scale_);
      const double m1 = s[1] / s[0], m2 = s[2] / s[0], m3 = s[3] / s[0], m4 = s[4] / s[0];
      f.objective += std::log(s[0]);
      f.partition *= s[0];
      f.mean[k] = m1;
      f.energy += m2;
      f.variance[k] = m2 - m1 * m1;
      f.mixed[k] = m3 - m1 * m2;
      f.energy_variance += m4 - m2 * m2;
    }
    return f;
  }

  /// Newton direction; the Hessian is an arrow, eliminated from its diagonal.
  point direction(const value& f) const {
    double corner = f.energy_variance, rest = f.energy;
    const auto d = static_cast<std::size_t>(grid_.dimensions());
    for (std::size_t k = 0; k < d; ++k) {
      corner -= f.mixed[k] * f.mixed[k] / f.variance[k];
      rest -= f.mixed[k] * f.mean[k] / f.variance[k];
    }
    point p;
    p.gamma = rest / corner;
    for (std::size_t k = 0; k < d; ++k) p.beta[k] = (f.mean[k] - f.mixed[k] * p.gamma) / f.variance[k];
    return p;
  }

  const std::array<const double*, 3>& factors() const { return factors_; }

 private:
  const velocity_grid& grid_;
  const fluid_state& state_;
  double scale_;
  std::array<const double*, 3> factors_{};
};

}  // namespace

bool discrete_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m) {
  maxwellian_dual dual(grid, state);
  maxwellian_dual::point x;
  auto f = dual.evaluate(x);
  for (int iteration = 0; iteration < 60 && f.defect() > 1e-15; ++iteration) {
    const auto p = dual.direction(f);
    bool better = false;
    double step = 1.0;
    for (int halving = 0; halving < 40 && !better; ++halving, step *= 0.5) {
      maxwellian_dual::point trial;
      trial.gamma = x.gamma - step * p.gamma;
      for (std::size_t k = 0; k < 3; ++k) trial.beta[k] = x.beta[k] - step * p.beta[k];
      const auto g = dual.evaluate(trial);
      better = g.objective < f.objective || g.defect() < f.defect();  // false for NaN
      if (!better) continue;
      x = trial;
      f = g;
    }
    if (!better) break;  // round-off is reached, or there is no solution
  }
  f = dual.evaluate(x);
  // Round-off of sums of `points` terms, with a margin; anything larger (or NaN) means that no solution
  // exists.
  if (!(f.defect() < 1e-12)) return false;
  tensor_product(grid, state.rho / (grid.weight() * f.partition), dual.factors(), m);
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
