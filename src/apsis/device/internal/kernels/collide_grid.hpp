#pragma once

#include <apsis/device/internal/collision_stage.hpp>
#include <apsis/model/fluid_state.hpp>
#include <apsis/model/formulas/grid_sums.hpp>
#include <apsis/model/formulas/velocity_grid.hpp>

namespace apsis::kernels {

/// Stages of the BGK model whose velocities are the product of two or three even lines, eight lanes for each
/// cell. They share the Gaussians of all directions.
struct collide_grid {
  static constexpr const char* name = "collide_grid";                            ///< of the kernel
  static constexpr int halvings = 12;                                            ///< of the sums over lines
  static constexpr int most_lines = scalar::longest_chain_of_lines << halvings;  ///< which halves can be

  /// Arguments.
  struct arguments {
    collision_stage stage;   ///< of all cells
    const double *v,         ///< velocities of the last direction
        *functions;          ///< velocity_grid::functions_of_lines()
    int dimensions,          ///< 2 or 3
        points,              ///< of all directions together
        n[3];                ///< points of a direction
    double weight,           ///< of the sums
        spacing[3], max[3];  ///< Δv and end of a direction
  };

  /// Solves the stage of a cell together with seven other lanes. The memory of the block has a number for
  /// each lane, and `points` for each cell.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    if (of.dimensions == 2) {
      solve<2>(lane, of);
    } else {
      solve<3>(lane, of);
    }
  }

 private:
  template <int Dimensions, class Lane>
  static APSIS_FORMULA void solve(const Lane& lane, const arguments& of) {
    using namespace scalar;
    constexpr int last = Dimensions - 1;
    const lane_group<Lane> group{lane, lane.shared()};
    const int cell = of.stage.cell_of(group);
    double* u = of.stage.u + cell * of.stage.stride;
    const fluid_state state = state_of<Dimensions>(group, of, u);
    const bool solved = of.stage.takes(group, state.admissible() && has_equilibrium<Dimensions>(of, state));
    functions_of_directions gaussians{Dimensions, {}, {}};
    double* values = lane.shared() + lane.count() + group.group() * of.points;
    for (int k = 0; k < Dimensions; ++k) {
      const int n = of.n[k];
      gaussians.n[k] = n;
      gaussians.g[k] = values;
      if (solved)
        gaussian_on_line(group, {n, of.spacing[k]}, {1.0, state.u[k], state.T}, [&](int j, double e) {
          if (j + group.place() < n) values[j + group.place()] = e;
        });
      values += n;
    }
    lane.wait();
    if (!solved) return;
    const auto weights = of.stage.weights(cell, state.rho, state.T);
    const double* along = gaussians.g[last];
    const int n = of.n[last];
    multiply_across_lines(gaussians, state.height(Dimensions), [&](int line, double factor) {
      double* to = u + static_cast<long>(line) * n;
      for (int j = group.place(); j < n; j += octet_length)
        to[j] = collision_stage::solution(weights, to[j], factor * along[j]);
    });
  }

  /// From the moments of a row, as kinetic_moments().
  template <int Dimensions, class Group>
  static APSIS_FORMULA fluid_state state_of(const Group& group, const arguments& of, const double* u) {
    using namespace scalar;
    constexpr int last = Dimensions - 1;
    int lines = of.n[0];
    if (Dimensions == 3) lines *= of.n[1];
    sums_of_powers<double> sums[Dimensions + 1];
    sum_powers<Dimensions + 1, halvings>(group, {u, of.n[last], lines, of.functions}, of.v, nullptr, 0.0,
                                         sums);
    double omega[Dimensions + 2];
    omega[0] = of.weight * group.total(sums[0].of[0]);
    for (int k = 0; k < last; ++k) omega[1 + k] = of.weight * group.total(sums[k + 1].of[0]);
    omega[Dimensions] = of.weight * group.total(sums[0].of[1]);
    omega[Dimensions + 1] =
        of.weight * energy_of_grid(group.total(sums[0].of[2]), group.total(sums[Dimensions].of[0]));
    return to_fluid_state(omega, Dimensions);
  }

  /// Whether the equilibrium of an admissible state is the formula.
  template <int Dimensions>
  static APSIS_FORMULA bool has_equilibrium(const arguments& of, const fluid_state& state) {
    bool exact = true;
    for (int k = 0; k < Dimensions; ++k)
      exact = exact &&
              scalar::gaussian_has_exact_moments(of.spacing[k], of.max[k], {state.rho, state.u[k], state.T});
    return exact || of.stage.any_formula != 0;
  }
};

}  // namespace apsis::kernels
