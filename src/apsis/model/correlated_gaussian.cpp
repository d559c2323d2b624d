#include <apsis/model/correlated_gaussian.hpp>

#include <apsis/exec/aligned.hpp>
#include <apsis/model/formulas/correlated.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace apsis {
namespace {

velocity_rows::gaussian curve_of(const scalar::gaussian_of_line& of) {
  return {of.a, of.u, of.T};
}

/// Fills m line by line. One vector exponential computes the heights of several lines.
template <int D>
void fill_lines(const velocity_grid& grid, const fluid_state& state,
                const scalar::conditional_gaussian<D>& of, double* m) {
  std::array<velocity_rows::gaussian, most_line_states>
      some;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  alignas(64) std::array<double, most_line_states> heights{};
  std::array<std::array<double, 2>, most_line_states> across{};
  const int n = grid.last_line().points();
  const double u = state.u[grid.last_component()];
  for (int first = 0; first < grid.lines(); first += most_line_states) {
    const int count = std::min(most_line_states, grid.lines() - first);
    for (int i = 0; i < count; ++i) {
      auto& c = across[static_cast<std::size_t>(i)];
      for (int k = 0; k + 1 < D; ++k)
        c[static_cast<std::size_t>(k)] =
            grid.component_of_lines(k)[first + i] - state.u[grid.component_across(k)];
      heights[static_cast<std::size_t>(i)] = of.log_of_relative_height(c.data());
    }
    velocity_rows::exponentials(0.0, count, heights.data());
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      some[i] = curve_of(of.on_line(across[i].data(), u, heights[i]));
    gaussians_on(grid.last_line(), some.data(), count, m + static_cast<std::ptrdiff_t>(first) * n, n);
  }
}

/// rows ← one Gaussian along the direction `along` for each velocity of direction k.
template <class Curve>
void find_rows(const velocity_grid& grid, int k, int along, const Curve& curve,
               aligned_vector<double>& rows) {
  const auto& v = grid.line(k).v();
  const int n = grid.line(along).points();
  rows.resize(v.size() * static_cast<std::size_t>(n));
  thread_local std::vector<velocity_rows::gaussian> curves;
  curves.clear();
  for (const double at : v) curves.push_back(curve_of(curve(at)));
  gaussians_on(grid.line(along), curves.data(), static_cast<int>(curves.size()), rows.data(), n);
}

bool fit(const scalar::correlated_tables& tables, const velocity_grid& grid, const fluid_state& state) {
  double farthest[3];
  for (int k = 0; k < 3; ++k) {
    const auto& v = grid.line(k).v();
    farthest[k] = std::max(std::abs(v.front() - state.u[k]), std::abs(v.back() - state.u[k]));
  }
  return tables.fit(farthest);
}

void multiply_tables(const scalar::correlated_tables& tables, const velocity_grid& grid, double* m) {
  thread_local std::array<aligned_vector<double>, 3> of_lines;
  find_rows(grid, 0, 1, [&](double v) { return tables.across(v); }, of_lines[0]);
  for (int k = 0; k < 2; ++k)
    find_rows(
        grid, k, 2, [&](double v) { return tables.along(k, v); }, of_lines[static_cast<std::size_t>(k) + 1]);
  const auto n = static_cast<std::size_t>(grid.line(2).points()),
             rows = static_cast<std::size_t>(grid.line(0).points()),
             lines = static_cast<std::size_t>(grid.line(1).points());
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < lines; ++j, m += n) {
      const double factor = of_lines[0][i * lines + j];
      const double *first = of_lines[1].data() + i * n, *second = of_lines[2].data() + j * n;
#pragma omp simd
      for (std::size_t k = 0; k < n; ++k) m[k] = factor * first[k] * second[k];
    }
}

template <int D>
scalar::small_matrix<D> part_of(const direction_matrix& whole) {
  scalar::small_matrix<D> part;
  for (int k = 0; k < D; ++k)
    for (int l = 0; l < D; ++l) part.of[k][l] = whole.of[k][l];
  return part;
}

template <int D>
void fill(const velocity_grid& grid, const fluid_state& state, const direction_matrix& covariance,
          const direction_matrix& inverse, double* m) {
  int across[2] = {0, 0};
  for (int k = 0; k + 1 < D; ++k) across[k] = grid.component_across(k);
  const auto of = scalar::conditional_gaussian<D>::of(state.rho, part_of<D>(covariance), part_of<D>(inverse),
                                                      grid.last_component(), across);
  if constexpr (D == 3)
    if (!grid.is_polar()) {
      const auto tables = scalar::correlated_tables::from(of, state.u);
      if (fit(tables, grid, state)) return multiply_tables(tables, grid, m);
    }
  fill_lines(grid, state, of, m);
}

}  // namespace

void correlated_gaussian(const velocity_grid& grid, const fluid_state& state,
                         const direction_matrix& covariance, const direction_matrix& inverse, double* m) {
  switch (grid.dimensions()) {
    case 1:
      return fill<1>(grid, state, covariance, inverse, m);
    case 2:
      return fill<2>(grid, state, covariance, inverse, m);
    default:
      return fill<3>(grid, state, covariance, inverse, m);
  }
}

}  // namespace apsis
