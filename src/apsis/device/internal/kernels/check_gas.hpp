#pragma once

#include <apsis/device/internal/lane_group.hpp>
#include <apsis/model/formulas/grid_sums.hpp>
#include <apsis/model/formulas/velocity_line.hpp>
#include <apsis/scheme/formulas/row.hpp>

namespace apsis::kernels {

/// The checks of the rows of a gas whose velocities are an even line: extremes, moments and entropy of every
/// cell, by eight lanes.
struct check_line {
  static constexpr const char* name = "check_line";  ///< of the kernel
  static constexpr int halvings = 4;                 ///< of the sums over velocities
  /// Largest number of velocities.
  static constexpr int most_velocities = scalar::longest_chain_of_line << halvings;
  static constexpr int lanes = 128;        ///< of a block
  static constexpr int cells = lanes / 8;  ///< of a block

  /// Numbers of a cell.
  enum number {
    lowest,    ///< minimum; NaN if some number is not finite
    negative,  ///< how many are negative
    unclear,   ///< 1 if the minimum is a zero of both signs: the host then decides
    density,   ///< ρ, ρu, 𝓔
    entropy = density + 3,
    numbers  ///< how many
  };

  /// Arguments.
  struct arguments {
    const double* u;   ///< rows of all cells
    double* checks;    ///< numbers of all cells
    const double *v,   ///< velocities
        *half_square;  ///< ½v²
    long stride;       ///< numbers of a row
    int first, last;   ///< cells
    int n;             ///< number of velocities
    double weight;     ///< of the sums
  };

  /// Checks the row of a cell together with seven other lanes.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    using namespace scalar;
    const lane_group<Lane> group{lane, lane.shared()};
    const int place = of.first + lane.block() * cells + group.group();
    // Lanes behind the last cell take part in the sums.
    const int cell = place < of.last ? place : of.last - 1;
    const double* u = of.u + cell * of.stride;
    row_contents<double> mine(__builtin_inf(), 0.0, 0.0);
    double zeros = 0.0, minus_zeros = 0.0;
    for (int k = group.place(); k < of.n; k += octet_length) {
      mine.add(u[k]);
      if (u[k] == 0.0) (bits_of(u[k]) == 0 ? zeros : minus_zeros) += 1.0;
    }
    const double least = lowest_of(lane, group, mine.lowest), below = group.total(mine.negative),
                 not_finite = group.total(mine.not_finite);
    // Every lane takes part in both totals.
    const double all_zeros = group.total(zeros), all_minus_zeros = group.total(minus_zeros);
    const moments_of_line sums = moments_of_row<halvings>(group, u, of.v, of.half_square, of.n);
    const double of_entropy = entropy_of_row(group, nullptr, u, nullptr, 0.0, of.n);
    if (place >= of.last || group.place() != 0) return;
    double* to = of.checks + static_cast<long>(cell) * numbers;
    to[lowest] = not_finite == not_finite ? least : __builtin_nan("");
    to[negative] = below;
    to[unclear] = least == 0.0 && all_zeros > 0.0 && all_minus_zeros > 0.0 ? 1.0 : 0.0;
    to[density] = of.weight * sums.mass;
    to[density + 1] = of.weight * sums.momentum;
    to[density + 2] = of.weight * sums.energy;
    to[entropy] = of.weight * of_entropy;
  }

 private:
  /// The smallest number of a group.
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
