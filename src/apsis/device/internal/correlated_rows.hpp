#pragma once

#include <apsis/device/internal/grid_equilibrium.hpp>
#include <apsis/model/formulas/correlated.hpp>

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
    if constexpr (Dimensions == 3) {
      const auto by_tables = correlated_tables::from(of, state.u);
      const bool fits = by_tables.fit(farthest(rows, state).of);
      if (fits) put_tables(group, rows, by_tables, tables);
      group.lane.wait();
      if (fits) {
        multiply_tables(group, rows, tables, row);
      } else {
        put_lines(group, rows, state, of, row);
      }
    } else {
      put_lines(group, rows, state, of, row);
    }
    group.lane.wait();
  }

 private:
  struct ends {
    double of[3];
  };
  /// Returns the largest |c_k| for every k.
  static APSIS_FORMULA ends farthest(const gas_rows& rows, const fluid_state& state) {
    ends found{};
    for (int k = 0; k < 3; ++k) {
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

  template <class Group>
  static APSIS_FORMULA void put_tables(const Group& group, const gas_rows& rows,
                                       const scalar::correlated_tables& of, double* tables) {
    const int n0 = rows.of[0].n, n1 = rows.of[1].n, n2 = rows.of[2].n;
    double *first = tables + n0 * n1, *second = first + n0 * n2;
    for (int i = 0; i < n0; ++i) {
      put_gaussian(group, rows.of[1], of.across(rows.of[0].v[i]), tables + i * n1);
      put_gaussian(group, rows.of[2], of.along(0, rows.of[0].v[i]), first + i * n2);
    }
    for (int j = 0; j < n1; ++j)
      put_gaussian(group, rows.of[2], of.along(1, rows.of[1].v[j]), second + j * n2);
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
