#include <apsis/model/correlated_gaussian.hpp>

#include <apsis/exec/aligned.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <Eigen/Dense>

namespace apsis {
namespace {

using matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
using whole_matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

matrix resolved(const direction_matrix& of, int dimensions) {
  return Eigen::Map<const whole_matrix>(of.front().data()).topLeftCorner(dimensions, dimensions);
}

/// The Gaussian in its last component c: a(c') exp(−(c − s·c')²/(2V)), where c' are the other components, a
/// is a Gaussian in them, s the slopes of the mean and V its variance.
struct conditional {
  conditional(const velocity_grid& grid, const fluid_state& state, const matrix& covariance,
              const matrix& inverse)
      : last(grid.dimensions() - 1),
        variance(1.0 / inverse(last, last)),
        height(state.rho /
               std::sqrt(std::pow(2.0 * std::numbers::pi, last + 1.0) * covariance.determinant())) {
    if (last > 0) outer = covariance.topLeftCorner(last, last).inverse();
    for (int k = 0; k < last; ++k) slope[static_cast<std::size_t>(k)] = -inverse(last, k) * variance;
  }

  /// −½ c'ᵀ(outer)c'.
  double exponent(const std::array<double, 2>& c) const {
    double sum = 0.0;
    for (int k = 0; k < last; ++k)
      for (int l = 0; l < last; ++l)
        sum -= 0.5 * c[static_cast<std::size_t>(k)] * outer(k, l) * c[static_cast<std::size_t>(l)];
    return sum;
  }
  /// s·c'.
  double shift(const std::array<double, 2>& c) const { return slope[0] * c[0] + slope[1] * c[1]; }

  int last;
  double variance, height;
  matrix outer;
  std::array<double, 2> slope{};
};

/// The components c' of a line.
std::array<double, 2> place(const velocity_grid& grid, const fluid_state& state, int line) {
  std::array<double, 2> c{};
  for (int k = 0; k + 1 < grid.dimensions(); ++k)
    c[static_cast<std::size_t>(k)] = grid.component_of_lines(k)[line] - state.u[k];
  return c;
}

/// Line by line.
void fill_lines(const velocity_grid& grid, const fluid_state& state, const conditional& of, double* m) {
  std::array<velocity_rows::gaussian, most_line_states>
      some;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  const int n = grid.last_line().points();
  for (int first = 0; first < grid.lines(); first += most_line_states) {
    const int count = std::min(most_line_states, grid.lines() - first);
    for (int i = 0; i < count; ++i) {
      const auto c = place(grid, state, first + i);
      some[static_cast<std::size_t>(i)] = {of.height * std::exp(of.exponent(c)),
                                           state.u[of.last] + of.shift(c), of.variance};
    }
    gaussians_on(grid.last_line(), some.data(), count, m + static_cast<std::ptrdiff_t>(first) * n, n);
  }
}

/// The velocities of a direction relative to u.
std::vector<double> distances(const velocity_grid& grid, const fluid_state& state, int k) {
  std::vector<double> c;
  for (const double v : grid.line(k).v()) c.push_back(v - state.u[k]);
  return c;
}

/// Largest sum of the exponents below: all values and factors are normal numbers.
constexpr double most = 600.0;

/// Whether the factors of fill_product() are normal numbers.
bool fits_product(const velocity_grid& grid, const fluid_state& state, const conditional& of) {
  std::array<double, 2> c{};
  double farthest = 0.0, square = 0.0;
  for (int k = 0; k < 3; ++k) {
    const auto& v = grid.line(k).v();
    const double end = std::max(std::abs(v.front() - state.u[k]), std::abs(v.back() - state.u[k]));
    if (k == of.last) {
      farthest = end;
    } else {
      c[static_cast<std::size_t>(k)] = end;
      square += end * end;
    }
  }
  const double shift = std::abs(of.slope[0]) * c[0] + std::abs(of.slope[1]) * c[1];
  return 0.5 * of.outer.norm() * square + 0.5 * (farthest + shift) * (farthest + shift) / of.variance <
             most &&
         of.height > 1e-30 && of.height < 1e30;
}

/// Three directions: with c'·s = s₁c₁ + s₂c₂ the Gaussian is
///   a exp(−(s·c')²/(2V)) · exp(−c²/(2V) + s₁c₁c/V) · exp(s₂c₂c/V),
/// a number for each line and two tables, which take fewer exponentials than lines do.
void fill_product(const velocity_grid& grid, const fluid_state& state, const conditional& of, double* m) {
  const auto c0 = distances(grid, state, 0), c1 = distances(grid, state, 1), c = distances(grid, state, 2);
  const std::size_t n = c.size();
  thread_local std::vector<double> of_first, of_second;
  of_first.clear();
  of_second.clear();
  for (const double at : c0)
    for (const double one : c)
      of_first.push_back(std::exp((of.slope[0] * at - 0.5 * one) * one / of.variance));
  for (const double at : c1)
    for (const double one : c) of_second.push_back(std::exp(of.slope[1] * at * one / of.variance));
  for (std::size_t i = 0; i < c0.size(); ++i)
    for (std::size_t j = 0; j < c1.size(); ++j, m += n) {
      const std::array<double, 2> at = {c0[i], c1[j]};
      const double shift = of.shift(at),
                   factor = of.height * std::exp(of.exponent(at) - 0.5 * shift * shift / of.variance);
      const double *first = of_first.data() + i * n, *second = of_second.data() + j * n;
#pragma omp simd
      for (std::size_t k = 0; k < n; ++k) m[k] = factor * first[k] * second[k];
    }
}

}  // namespace

void correlated_gaussian(const velocity_grid& grid, const fluid_state& state,
                         const direction_matrix& covariance, const direction_matrix& inverse, double* m) {
  const int d = grid.dimensions();
  const conditional of(grid, state, resolved(covariance, d), resolved(inverse, d));
  if (d == 3 && fits_product(grid, state, of)) return fill_product(grid, state, of, m);
  fill_lines(grid, state, of, m);
}

}  // namespace apsis
