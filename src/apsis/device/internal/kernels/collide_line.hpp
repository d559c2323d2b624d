#pragma once

#include <apsis/device/internal/collision_stage.hpp>

namespace apsis::kernels {

/// Stages of the BGK model whose velocities are an even line, eight lanes for each cell.
struct collide_line {
  static constexpr const char* name = "collide_line";         ///< of the kernel
  static constexpr int longest_chain = 256;                   ///< of velocity_rows
  static constexpr int most_velocities = 16 * longest_chain;  ///< which halves can be

  /// Arguments.
  struct arguments {
    collision_stage stage;  ///< of all cells
    const double *v,        ///< velocities
        *half_square;       ///< ½v²
    int n;                  ///< number of velocities
    double spacing,         ///< Δv
        weight,             ///< of the sums
        max;                ///< the end of the line
  };

  /// Solves the stage of a cell together with seven other lanes.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    using namespace scalar;
    const lane_group<Lane> group{lane, lane.shared()};
    const int cell = of.stage.cell_of(group);
    double* u = of.stage.u + cell * of.stage.stride;
    const moments_of_line sums = moments<4>(group, u, of.v, of.half_square, of.n);
    const state_of_line state =
        state_of_line::of(of.weight * sums.mass, of.weight * sums.momentum, of.weight * sums.energy);
    if (!of.stage.takes(group, state.admissible() && (of.stage.any_formula != 0 ||
                                                      gaussian_has_exact_moments(of.spacing, of.max, state))))
      return;
    const auto weights = of.stage.weights(cell, state.rho, state.T);
    gaussian_on_line(group, {of.n, of.spacing}, {state.height(), state.u, state.T}, [&](int k, double e) {
      const int j = k + group.place();
      if (j < of.n) u[j] = collision_stage::solution(weights, u[j], e);
    });
  }

 private:
  /// Halves of halves, at whole cache lines, as velocity_rows::moments().
  template <int Depth, class Group>
  static APSIS_FORMULA scalar::moments_of_line moments(const Group& group, const double* f, const double* v,
                                                       const double* half_square, int n) {
    if constexpr (Depth > 0)
      if (n > longest_chain) {
        const int half = (n / 2 + 7) / 8 * 8;
        const auto before = moments<Depth - 1>(group, f, v, half_square, half),
                   behind = moments<Depth - 1>(group, f + half, v + half, half_square + half, n - half);
        return {before.mass + behind.mass, before.momentum + behind.momentum, before.energy + behind.energy};
      }
    scalar::moments_of_line sums;
    scalar::sum_moments<1>(group, f, 0, v, half_square, n, &sums);
    return sums;
  }
};

}  // namespace apsis::kernels
