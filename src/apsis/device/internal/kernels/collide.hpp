#pragma once

#include <apsis/device/internal/collision_stage.hpp>
#include <apsis/device/internal/grid_equilibrium.hpp>

namespace apsis::kernels {

/// Solves stages of the BGK model on a velocity line, or on the product of two or three lines. Eight lanes
/// for each cell share the equilibrium along each direction.
struct collide {
  static constexpr const char* name = "collide";  ///< name of the kernel

  /// Arguments.
  struct arguments {
    collision_stage stage;              ///< stage of all cells
    gas_rows rows;                      ///< rows of the gas
    equilibrium_formulas closed_forms;  ///< which equilibria are formulas
  };

  /// Solves the stage of a cell together with seven other lanes. The block has shared memory for most_totals
  /// numbers per lane and gas_rows::points numbers per cell.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    with_dimensions(of.rows.dimensions,
                    [&](auto dimensions) APSIS_INLINED { solve<decltype(dimensions)::value>(lane, of); });
  }

 private:
  template <int Dimensions, class Lane>
  static APSIS_FORMULA void solve(const Lane& lane, const arguments& of) {
    const gas_rows& rows = of.rows;
    const lane_group<Lane> group{lane, lane.shared()};
    const int cell = of.stage.cell_of(group);
    double* u = of.stage.u + cell * of.stage.stride;
    double omega[Dimensions + 2];
    rows.moments<Dimensions>(group, u, omega);
    const fluid_state state = rows.state<Dimensions>(omega);
    grid_equilibrium<Dimensions> m;
    m.find(group, rows, of.closed_forms, omega, state,
           lane.shared() + most_totals * lane.count() + group.group() * rows.points);
    if (!of.stage.takes(group, m.found)) return;
    const auto weights = of.stage.weights(cell, state.rho, state.T);
    const double* last = m.along.g[Dimensions - 1];
    const int n = m.along.n[Dimensions - 1];
    multiply_across_lines(m.along, m.factor, [&](int line, double factor_of_line) {
      double* to = u + static_cast<long>(line) * n;
      for (int j = group.place(); j < n; j += scalar::octet_length) {
        const double e = factor_of_line * last[j];
        to[j] = collision_stage::solution(weights, to[j], e);
        if (!rows.reduced()) continue;
        double& h = to[rows.size + j];
        h = collision_stage::solution(weights, h, m.others * e);
      }
    });
  }
};

}  // namespace apsis::kernels
