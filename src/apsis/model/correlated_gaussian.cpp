#include <apsis/model/correlated_gaussian.hpp>

#include <apsis/exec/aligned.hpp>
#include <apsis/model/formulas/correlated.hpp>
#include <apsis/model/plane_rows.hpp>

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

bool walks_over(const velocity_line& rows, const scalar::correlated_plane& of, double variance) {
  return rows.uniform() && of.walks(rows.spacing(), variance);
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

/// to ← the plane of the directions k and `along`, row by row. `variance` is that of component k.
void fill_plane(const velocity_grid& grid, const fluid_state& state, const scalar::correlated_plane& of,
                int k, int along, double variance, double* to) {
  const velocity_line &across = grid.line(k), &line = grid.line(along);
  const int n = line.points();
  const double u = state.u[along];
  if (walks_over(across, of, variance))
    return plane_rows::fill(of.walk({across.points(), across.spacing()}, state.u[k], u), line.v().data(), n,
                            to);
  thread_local std::vector<velocity_rows::gaussian> curves;
  curves.clear();
  for (const double v : across.v()) curves.push_back(curve_of(of.row(v - state.u[k], u)));
  gaussians_on(line, curves.data(), across.points(), to, n);
}

double farthest(const velocity_grid& grid, const fluid_state& state, int k) {
  const auto& v = grid.line(k).v();
  return std::max(std::abs(v.front() - state.u[k]), std::abs(v.back() - state.u[k]));
}

/// m ← the Gaussian as a product of tables. Returns false, with m undefined, if they leave the range of
/// normal numbers.
bool multiply_tables(const velocity_grid& grid, const fluid_state& state,
                     const scalar::conditional_gaussian<3>& of, const direction_matrix& covariance,
                     double* m) {
  const auto tables = scalar::correlated_tables::from(of);
  const double ends[] = {farthest(grid, state, 0), farthest(grid, state, 1), farthest(grid, state, 2)};
  if (!tables.fit(ends)) return false;
  thread_local std::array<aligned_vector<double>, 3> rows;
  const int n[] = {grid.line(0).points(), grid.line(1).points(), grid.line(2).points()};
  const auto fill = [&](aligned_vector<double>& to, const scalar::correlated_plane& plane, int k, int along) {
    to.resize(static_cast<std::size_t>(n[k]) * static_cast<std::size_t>(n[along]));
    fill_plane(grid, state, plane, k, along, covariance.of[k][k], to.data());
  };
  fill(rows[0], tables.across, 0, 1);
  fill(rows[1], tables.along[0], 0, 2);
  fill(rows[2], tables.along[1], 1, 2);
  plane_rows::multiply({{n[0], n[1], n[2]}, rows[0].data(), rows[1].data(), rows[2].data()}, m);
  return true;
}

/// m ← the Gaussian by a walk over its rows. Returns false if this is less accurate than exponentials.
bool walk_over_plane(const velocity_grid& grid, const fluid_state& state, const scalar::correlated_plane& of,
                     double variance, double* m) {
  const double across = farthest(grid, state, 0) + grid.line(0).spacing();
  if (!(walks_over(grid.line(0), of, variance) &&
        scalar::are_normal(of.height, of.largest_exponent(across, farthest(grid, state, 1)))))
    return false;
  fill_plane(grid, state, of, 0, 1, variance, m);
  return true;
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
  if constexpr (D == 2)
    if (walk_over_plane(grid, state, scalar::plane_of(of), covariance.of[0][0], m)) return;
  if constexpr (D == 3)
    if (!grid.is_polar() && multiply_tables(grid, state, of, covariance, m)) return;
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
