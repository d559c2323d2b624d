#pragma once

#include <apsis/device/internal/grid_equilibrium.hpp>
#include <apsis/model/formulas/correlated.hpp>
#include <apsis/model/formulas/plane.hpp>

namespace apsis::kernels {

/// Rows of Gaussians with correlated velocity components, as correlated_gaussian(), with eight lanes for
/// each row.
template <int Dimensions>
struct correlated_rows {
  /// Returns how many numbers the tables of a row have, which three dimensions need; otherwise 0.
  static constexpr APSIS_FORMULA long numbers_of_tables(const gas_rows& rows) {
    if (rows.dimensions < 3) return 0;
    const long n0 = rows.of[0].n, n1 = rows.of[1].n, n2 = rows.of[2].n;
    return n0 * n1 + n0 * n2 + n1 * n2;
  }

  /// row ← the Gaussian. All lanes of the block may read it when this function returns. The numbers are
  /// arbitrary if the covariance is not positive definite.
  template <class Group>
  static APSIS_FORMULA void put(const Group& group, const gas_rows& rows, const fluid_state& state,
                                const scalar::small_matrix<Dimensions>& covariance,
                                const scalar::small_matrix<Dimensions>& inverse, double* tables,
                                double* row) {
    using namespace scalar;
    constexpr int last = Dimensions - 1;
    const int across[] = {0, 1};
    const auto of = conditional_gaussian<Dimensions>::of(state.rho, covariance, inverse, last, across);
    const ends most = farthest(rows, state);
    bool fits = false;
    if constexpr (Dimensions == 2) {
      const auto plane = plane_of(of);
      const double variance = covariance.of[0][0];
      fits = walks_over(rows.of[0], plane, variance) &&
             are_normal(plane.height, plane.largest_exponent(most.of[0] + rows.of[0].spacing, most.of[1]));
      if (fits) put_plane(group, rows, state, plane, 0, 1, variance, row);
    }
    if constexpr (Dimensions == 3) {
      const auto by_tables = correlated_tables::from(of);
      fits = by_tables.fit(most.of);
      if (fits) put_tables(group, rows, state, by_tables, covariance, tables);
      group.lane.wait();
      if (fits) multiply_tables(group, rows, tables, row);
    }
    if (!fits) put_lines(group, rows, state, of, row);
    group.lane.wait();
  }

 private:
  struct ends {
    double of[3];
  };
  /// Returns the largest |c_k| for every k.
  static APSIS_FORMULA ends farthest(const gas_rows& rows, const fluid_state& state) {
    ends found{};
    for (int k = 0; k < Dimensions; ++k) {
      const auto& of = rows.of[k];
      const double first = __builtin_fabs(of.v[0] - state.u[k]),
                   last = __builtin_fabs(of.v[of.n - 1] - state.u[k]);
      found.of[k] = first < last ? last : first;
    }
    return found;
  }

  /// row ← the Gaussian, line by line.
  template <class Group>
  static APSIS_FORMULA void put_lines(const Group& group, const gas_rows& rows, const fluid_state& state,
                                      const scalar::conditional_gaussian<Dimensions>& of, double* row) {
    const auto& last = rows.of[Dimensions - 1];
    const int lines = rows.size / last.n;
    for (int line = 0; line < lines; ++line) {
      double c[2];
      rows.components_across<Dimensions>(line, state.u, c);
      put_gaussian(group, last, of.on_line(c, state.u[Dimensions - 1]),
                   row + static_cast<long>(line) * last.n);
    }
  }

  static APSIS_FORMULA bool walks_over(const gas_rows::direction& of, const scalar::correlated_plane& plane,
                                       double variance) {
    return of.even != 0 && plane.walks(of.spacing, variance);
  }

  /// to ← the plane of the directions k and `along`, row by row. `variance` is that of component k.
  template <class Group>
  static APSIS_FORMULA void put_plane(const Group& group, const gas_rows& rows, const fluid_state& state,
                                      const scalar::correlated_plane& plane, int k, int along,
                                      double variance, double* to) {
    const auto &across = rows.of[k], &line = rows.of[along];
    const double u = state.u[along];
    if (walks_over(across, plane, variance)) {
      const auto walk = plane.walk({across.n, across.spacing}, state.u[k], u);
      return scalar::walk_over_rows(group, walk, line.v, line.n, [&](int row, int j, double value) {
        group.store(value, line.n - j, to + static_cast<long>(row) * line.n + j);
      });
    }
    for (int i = 0; i < across.n; ++i)
      put_gaussian(group, line, plane.row(across.v[i] - state.u[k], u), to + static_cast<long>(i) * line.n);
  }

  template <class Group>
  static APSIS_FORMULA void put_tables(const Group& group, const gas_rows& rows, const fluid_state& state,
                                       const scalar::correlated_tables& of,
                                       const scalar::small_matrix<Dimensions>& covariance, double* tables) {
    const int n0 = rows.of[0].n, n1 = rows.of[1].n, n2 = rows.of[2].n;
    double *first = tables + n0 * n1, *second = first + n0 * n2;
    put_plane(group, rows, state, of.across, 0, 1, covariance.of[0][0], tables);
    put_plane(group, rows, state, of.along[0], 0, 2, covariance.of[0][0], first);
    put_plane(group, rows, state, of.along[1], 1, 2, covariance.of[1][1], second);
  }

  template <class Group>
  static APSIS_FORMULA void multiply_tables(const Group& group, const gas_rows& rows, const double* tables,
                                            double* row) {
    const int n0 = rows.of[0].n, n1 = rows.of[1].n, n2 = rows.of[2].n;
    const double *first = tables + n0 * n1, *second = first + n0 * n2;
    for (int i = 0; i < n0; ++i)
      for (int j = 0; j < n1; ++j, row += n2)
        for (int k = group.place(); k < n2; k += scalar::octet_length)
          row[k] = tables[i * n1 + j] * first[i * n2 + k] * second[j * n2 + k];
  }
};

}  // namespace apsis::kernels
