#pragma once

#include <apsis/device/internal/gas_rows.hpp>
#include <apsis/scheme/formulas/row.hpp>

namespace apsis::kernels {

/// Checks the rows of a gas: computes extremes, moments and entropy of every cell, with eight lanes for each.
struct check_gas {
  static constexpr const char* name = "check_gas";  ///< name of the kernel
  static constexpr int lanes = 128;                 ///< lanes of a block
  static constexpr int cells = lanes / 8;           ///< cells of a block

  /// Numbers of a cell.
  enum number {
    lowest,    ///< minimum; NaN if some number is not finite
    negative,  ///< how many numbers are negative
    unclear,   ///< 1 if the minimum is 0 and the row has zeros of both signs: the host then decides
    entropy,   ///< entropy of the row
    density    ///< ρ, ρu, 𝓔
  };
  /// Returns how many numbers a cell has.
  static constexpr int numbers(int dimensions) { return density + dimensions + 2; }

  /// Arguments.
  struct arguments {
    const double* u;  ///< rows of all cells
    double* checks;   ///< numbers of all cells
    gas_rows rows;    ///< rows of the gas
    long stride;      ///< numbers of a row
    int first, last;  ///< cells first … last − 1
  };

  /// Checks the row of a cell together with seven other lanes.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    const lane_group<Lane> group{lane, lane.shared()};
    const int place = of.first + lane.block() * cells + group.group();
    // Lanes beyond the last cell take part in the sums.
    const int cell = place < of.last ? place : of.last - 1;
    const bool stores = place < of.last && group.place() == 0;
    const double* u = of.u + cell * of.stride;
    double* to = of.checks + static_cast<long>(cell) * numbers(of.rows.dimensions);
    check_extremes(lane, group, of.rows.reduced() ? 2 * of.rows.size : of.rows.size, u, stores, to);
    with_dimensions(of.rows.dimensions, [&](auto dimensions) {
      constexpr int d = decltype(dimensions)::value;
      double omega[d + 2];
      of.rows.moments<d>(group, u, omega);
      if (stores)
        for (int k = 0; k < d + 2; ++k) to[density + k] = omega[k];
    });
    const double of_entropy = of.rows.entropy(group, u);
    if (stores) to[entropy] = of.rows.weight * of_entropy;
  }

 private:
  template <class Lane>
  static APSIS_FORMULA void check_extremes(const Lane& lane, const lane_group<Lane>& group, int n,
                                           const double* u, bool stores, double* to) {
    using namespace scalar;
    row_contents<double> mine(__builtin_inf(), 0.0, 0.0);
    double zeros = 0.0, minus_zeros = 0.0;
    for (int k = group.place(); k < n; k += octet_length) {
      mine.add(u[k]);
      if (u[k] == 0.0) (bits_of(u[k]) == 0 ? zeros : minus_zeros) += 1.0;
    }
    const double least = lowest_of(lane, group, mine.lowest), below = group.total(mine.negative),
                 not_finite = group.total(mine.not_finite);
    // Every lane takes part in both totals.
    const double all_zeros = group.total(zeros), all_minus_zeros = group.total(minus_zeros);
    if (!stores) return;
    to[lowest] = not_finite == not_finite ? least : __builtin_nan("");
    to[negative] = below;
    to[unclear] = least == 0.0 && all_zeros > 0.0 && all_minus_zeros > 0.0 ? 1.0 : 0.0;
  }

  /// Returns the smallest number of a group.
  template <class Lane>
  static APSIS_FORMULA double lowest_of(const Lane& lane, const lane_group<Lane>& group, double mine) {
    group.shared[lane.index()] = mine;
    lane.wait();
    double least = mine;
    for (int k = 0; k < scalar::octet_length; ++k)
      least = scalar::smaller(group.shared[scalar::octet_length * group.group() + k], least);
    lane.wait();
    return least;
  }
};

}  // namespace apsis::kernels
