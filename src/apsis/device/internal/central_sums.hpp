#pragma once

#include <apsis/device/internal/gas_rows.hpp>

namespace apsis::kernels {

/// Central moments Σ w g Π_k c_k^p_k of a row g up to some degree, as in central_sums.
template <int Dimensions, int Degree>
struct central_sums_of_row {
  static constexpr int along(int dimension) { return Dimensions > dimension ? Degree + 1 : 1; }

  double of[along(0)][along(1)][along(2)] = {};  ///< of[p_1][p_2][p_3]

  /// Returns the moment with exponents p.
  APSIS_FORMULA double operator()(const int* p) const { return of[p[0]][p[1]][p[2]]; }
  /// Returns Σ w c_k g.
  APSIS_FORMULA double first(int k) const { return of[k == 0][k == 1][k == 2]; }
  /// Returns Σ w c_k c_l g.
  APSIS_FORMULA double second(int k, int l) const {
    return of[(k == 0) + (l == 0)][(k == 1) + (l == 1)][(k == 2) + (l == 2)];
  }
  /// Returns Σ w c_k c_l² g.
  APSIS_FORMULA double third(int k, int l) const {
    return of[(k == 0) + 2 * (l == 0)][(k == 1) + 2 * (l == 1)][(k == 2) + 2 * (l == 2)];
  }
};

/// Memory for the sums of a cell up to some degree.
struct memory_of_central_sums {
  double *powers,  ///< shared: powers of the velocities of all directions but the last
      *planes;     ///< memory of the device, in three dimensions: a plane for each power of c_1

  /// Returns the length of `powers`.
  static constexpr APSIS_FORMULA int powers_of(const gas_rows& rows, int degree) {
    return (degree + 1) * (rows.points - rows.of[rows.dimensions - 1].n);
  }
  /// Returns the length of `planes`.
  static constexpr APSIS_FORMULA long planes_of(const gas_rows& rows, int degree) {
    return rows.dimensions < 3 ? 0 : static_cast<long>(degree + 1) * rows.of[1].n * rows.of[2].n;
  }
};

/// The accumulator of powers that central_sums uses for a degree.
template <bool MoreThanThree>
struct powers_of_degree {
  using sums = scalar::sums_of_powers<double>;
};
template <>
struct powers_of_degree<true> {
  using sums = scalar::sums_of_six_powers<double>;
};

/// Computes sums up to a highest degree, one direction after the other, with eight lanes for each row. All
/// lanes of a block must call each function together.
template <int Dimensions, int Highest, class Group>
struct central_summation {
  const Group& group;
  const gas_rows& rows;
  const double* u;                ///< bulk velocity
  memory_of_central_sums memory;  ///< memory of the cell

  /// Prepares the powers of c_k in all directions but the last.
  APSIS_FORMULA void start() const {
    for (int k = 0; k + 1 < Dimensions; ++k) {
      const auto& along = rows.of[k];
      for (int j = group.place(); j < along.n; j += scalar::octet_length) {
        const double c = along.v[j] - u[k];
        double power = rows.uniform != 0 ? 1.0 : along.weights[j];
        for (int p = 0; p <= Highest; ++p, power *= c) powers(k)[p * along.n + j] = power;
      }
    }
    group.lane.wait();
  }

  /// Returns the sums of a row.
  template <int Degree>
  APSIS_FORMULA central_sums_of_row<Dimensions, Degree> sum(const double* g) const {
    using namespace scalar;
    using accumulator = typename powers_of_degree<(Degree > 3)>::sums;
    central_sums_of_row<Dimensions, Degree> sums;
    const auto& last = rows.of[Dimensions - 1];
    if constexpr (Dimensions == 1) {
      auto all = powers_on_line<accumulator>(group, {last.n, last.v, last.weights}, u[0],
                                             row_of_line<Group>{group, g});
      group.totals(all.of);
      for (int p = 0; p <= Degree; ++p) sums.of[p][0][0] = rows.weight * all.of[p];
    } else if constexpr (Dimensions == 2) {
      sum_lines<accumulator, Degree + 1>(g, 0,
                                         [&](int p, int q, double s) APSIS_INLINED { sums.of[p][q][0] = s; });
    } else {
      sum_planes<Degree + 1>(g);
      sum_plane<accumulator, 0, Degree>(sums);
    }
    return sums;
  }

 private:
  APSIS_FORMULA double* powers(int k) const {
    return memory.powers + (k == 0 ? 0 : (Highest + 1) * rows.of[0].n);
  }

  /// Calls put(p, q, Σ w c_k^p c^q f) for all p + q < Functions, where c is the component along the last
  /// direction. `f` has a line along that direction for each velocity of direction k.
  template <class Powers, int Functions, class Put>
  APSIS_FORMULA void sum_lines(const double* f, int k, const Put& put) const {
    using namespace scalar;
    const auto& last = rows.of[Dimensions - 1];
    Powers all[Functions];
    sum_powers<Functions, gas_rows::halvings>(group, {f, last.n, rows.of[k].n, powers(k)}, last.v,
                                              last.weights, u[Dimensions - 1], all);
    for (int p = 0; p < Functions; ++p) {
      group.totals(all[p].of);
      for (int q = 0; p + q < Functions; ++q) put(p, q, rows.weight * all[p].of[q]);
    }
  }

  /// planes[p] ← Σ w c_1^p g over the first direction.
  template <int Functions>
  APSIS_FORMULA void sum_planes(const double* g) const {
    using namespace scalar;
    const int plane = rows.of[1].n * rows.of[2].n;
    const lines_of_grid of{g, plane, rows.of[0].n, powers(0)};
    group.lane.wait();  // other lanes may still read the planes of another row
    for (int j = 0; j < plane; j += octet_length) {
      double sum[Functions];
      sum_over_lines<Functions, 1, gas_rows::halvings>(group, columns_of_grid::from(of, j, 1), sum);
      for (int p = 0; p < Functions; ++p) group.store(sum[p], plane - j, memory.planes + p * plane + j);
    }
    group.lane.wait();
  }

  template <class Powers, int P, int Degree>
  APSIS_FORMULA void sum_plane(central_sums_of_row<Dimensions, Degree>& sums) const {
    const int plane = rows.of[1].n * rows.of[2].n;
    sum_lines<Powers, Degree - P + 1>(memory.planes + P * plane, 1,
                                      [&](int q, int r, double s) APSIS_INLINED { sums.of[P][q][r] = s; });
    if constexpr (P < Degree) sum_plane<Powers, P + 1, Degree>(sums);
  }
};

}  // namespace apsis::kernels
