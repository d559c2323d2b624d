#include <apsis/model/correlated_gaussian.hpp>

#include <apsis/exec/aligned.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace apsis {
namespace {

/// The Gaussian in the component c of the last line: a(c') exp(−(c − s·c')²/(2V)), where c' are the other
/// components, a is a Gaussian in them, s the slopes of the mean and V its variance.
struct conditional {
  conditional(const velocity_grid& grid, const fluid_state& state, const direction_matrix& covariance,
              const direction_matrix& inverse)
      : last(grid.last_component()), variance(1.0 / inverse[at(last)][at(last)]) {
    const auto& of = covariance;
    const int others = grid.dimensions() - 1;
    const std::size_t i = at(grid.component_across(0)), j = at(grid.component_across(1));
    double determinant = variance * 2.0 * std::numbers::pi;
    if (others == 1) {
      outer[0][0] = 1.0 / of[i][i];
      determinant *= of[i][i] * 2.0 * std::numbers::pi;
    } else if (others == 2) {
      const double of_others = of[i][i] * of[j][j] - of[i][j] * of[j][i];
      outer = {
          {{of[j][j] / of_others, -of[i][j] / of_others}, {-of[j][i] / of_others, of[i][i] / of_others}}};
      determinant *= of_others * (2.0 * std::numbers::pi) * (2.0 * std::numbers::pi);
    }
    height = state.rho / std::sqrt(determinant);
    for (int k = 0; k < others; ++k)
      slope[at(k)] = -inverse[at(last)][at(grid.component_across(k))] * variance;
  }

  /// −½ c'ᵀ(outer)c'.
  double exponent(const std::array<double, 2>& c) const {
    return -0.5 * (outer[0][0] * c[0] * c[0] + 2.0 * outer[0][1] * c[0] * c[1] + outer[1][1] * c[1] * c[1]);
  }
  /// s·c'.
  double shift(const std::array<double, 2>& c) const { return slope[0] * c[0] + slope[1] * c[1]; }

  int last;
  double variance, height = 0.0;
  std::array<std::array<double, 2>, 2> outer{};  ///< inverse of the covariance of c'
  std::array<double, 2> slope{};

 private:
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }
};

/// The components c' of a line.
std::array<double, 2> place(const velocity_grid& grid, const fluid_state& state, int line) {
  std::array<double, 2> c{};
  for (int k = 0; k + 1 < grid.dimensions(); ++k)
    c[static_cast<std::size_t>(k)] = grid.component_of_lines(k)[line] - state.u[grid.component_across(k)];
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

/// Largest sum of the exponents below: all values and factors are normal numbers.
constexpr double most = 600.0;

/// A Gaussian of three components, which differs from a product of lines by few factors: with s·c' = s₁c₁ +
/// s₂c₂ it is
///   a(c') exp((s₁c₁ − s₂c₂)²/(2V)) · exp(−(c − 2s₁c₁)²/(4V)) · exp(−(c − 2s₂c₂)²/(4V)),
/// one table in c₁ and c₂ and two in c. Each consists of Gaussians on lines.
class tables {
 public:
  tables(const velocity_grid& grid, const fluid_state& state, const conditional& of)
      : grid_(grid), state_(state), of_(of) {
    const double per_variance = 1.0 / of.variance;
    outer_ = of.outer;
    outer_[0][0] -= of.slope[0] * of.slope[0] * per_variance;
    outer_[1][1] -= of.slope[1] * of.slope[1] * per_variance;
    outer_[0][1] += of.slope[0] * of.slope[1] * per_variance;
  }

  /// Whether their values are normal numbers.
  bool fit() const {
    const bool bounded = outer_[1][1] > 0.0 && outer_[0][0] * outer_[1][1] > outer_[0][1] * outer_[0][1];
    if (!(bounded && of_.height > 1e-30 && of_.height < 1e30)) return false;
    std::array<double, 3> end{};
    for (int k = 0; k < 3; ++k) {
      const auto& v = grid_.line(k).v();
      end[static_cast<std::size_t>(k)] =
          std::max(std::abs(v.front() - state_.u[k]), std::abs(v.back() - state_.u[k]));
    }
    double sum = std::abs(outer_[0][1]) * end[0] * end[1];
    for (std::size_t k = 0; k < 2; ++k) {
      const double farthest = end[2] + 2.0 * std::abs(of_.slope[k]) * end[k];
      sum += 0.5 * outer_[k][k] * end[k] * end[k] + 0.25 * farthest * farthest / of_.variance;
    }
    return sum < most;
  }

  void fill(double* m) const {
    thread_local std::array<aligned_vector<double>, 3> of_lines;
    find_outer(of_lines[0]);
    find_along(0, of_lines[1]);
    find_along(1, of_lines[2]);
    const auto n = static_cast<std::size_t>(grid_.line(2).points()),
               rows = static_cast<std::size_t>(grid_.line(0).points()),
               lines = static_cast<std::size_t>(grid_.line(1).points());
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < lines; ++j, m += n) {
        const double factor = of_lines[0][i * lines + j];
        const double *first = of_lines[1].data() + i * n, *second = of_lines[2].data() + j * n;
#pragma omp simd
        for (std::size_t k = 0; k < n; ++k) m[k] = factor * first[k] * second[k];
      }
  }

 private:
  /// rows[i] ← Gaussians along the direction `along`, one for each velocity of direction k.
  template <class Curve>
  void find_rows(int k, int along, const Curve& curve, aligned_vector<double>& rows) const {
    const auto& v = grid_.line(k).v();
    const int n = grid_.line(along).points();
    rows.resize(v.size() * static_cast<std::size_t>(n));
    thread_local std::vector<velocity_rows::gaussian> curves;
    curves.clear();
    for (const double at : v) curves.push_back(curve(at - state_.u[k]));
    gaussians_on(grid_.line(along), curves.data(), static_cast<int>(curves.size()), rows.data(), n);
  }
  /// a(c') exp((s₁c₁ − s₂c₂)²/(2V)).
  void find_outer(aligned_vector<double>& rows) const {
    const double shift = -outer_[0][1] / outer_[1][1], rest = outer_[0][0] + outer_[0][1] * shift;
    find_rows(
        0, 1,
        [&](double c) {
          return velocity_rows::gaussian{of_.height * std::exp(-0.5 * rest * c * c), state_.u[1] + shift * c,
                                         1.0 / outer_[1][1]};
        },
        rows);
  }
  /// exp(−(c − 2s_k c_k)²/(4V)).
  void find_along(int k, aligned_vector<double>& rows) const {
    const double slope = 2.0 * of_.slope[static_cast<std::size_t>(k)];
    find_rows(
        k, 2,
        [&](double c) { return velocity_rows::gaussian{1.0, state_.u[2] + slope * c, 2.0 * of_.variance}; },
        rows);
  }

  const velocity_grid& grid_;
  const fluid_state& state_;
  const conditional& of_;
  std::array<std::array<double, 2>, 2> outer_{};  // of the first table; [1][0] is not used
};

}  // namespace

void correlated_gaussian(const velocity_grid& grid, const fluid_state& state,
                         const direction_matrix& covariance, const direction_matrix& inverse, double* m) {
  const conditional of(grid, state, covariance, inverse);
  if (grid.dimensions() == 3 && !grid.is_polar())
    if (const tables product(grid, state, of); product.fit()) return product.fill(m);
  fill_lines(grid, state, of, m);
}

}  // namespace apsis
