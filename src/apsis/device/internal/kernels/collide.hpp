#pragma once

#include <apsis/device/internal/collision_stage.hpp>
#include <apsis/model/fluid_state.hpp>
#include <apsis/model/formulas/grid_sums.hpp>
#include <apsis/model/formulas/nearby.hpp>
#include <apsis/model/formulas/velocity_grid.hpp>

namespace apsis::kernels {

/// Stages of the BGK model whose velocities are a line, or the product of two or three lines; eight lanes for
/// each cell. They share the equilibrium along each direction: Gaussians, or the weights that Newton's method
/// finds next to them.
struct collide {
  static constexpr const char* name = "collide";                                 ///< of the kernel
  static constexpr int halvings = 12;                                            ///< of the sums over lines
  static constexpr int most_lines = scalar::longest_chain_of_lines << halvings;  ///< which halves can be
  static constexpr int halvings_of_line = 4;                                     ///< of the sums along a line
  static constexpr int most_velocities_of_line = scalar::longest_chain_of_line
                                                 << halvings_of_line;  ///< which halves can be

  /// Velocities of a direction.
  struct direction {
    const double *v,      ///< velocities
        *weights;         ///< of the quadrature; nullptr: all are 1
    int n,                ///< how many
        even;             ///< whether they are evenly spaced
    double spacing, max;  ///< Δv and the end of the line, if so
  };

  /// Which equilibria are formulas.
  enum formulas {
    none,         ///< of no cell
    where_exact,  ///< where the moments are exact
    all           ///< of all cells
  };

  /// Arguments.
  struct arguments {
    collision_stage stage;    ///< of all cells
    direction of[3];          ///< each direction
    const double* functions;  ///< velocity_grid::functions_of_lines(), or ½v² of an even line
    int dimensions,           ///< 1, 2 or 3
        points,               ///< of all directions together
        uniform,              ///< whether all directions are evenly spaced
        closed_forms;         ///< which equilibria are formulas
    double weight;            ///< of the sums
  };

  /// Solves the stage of a cell together with seven other lanes. The memory of the block has
  /// most_totals for each lane, and `points` for each cell.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    if (of.dimensions == 1) {
      solve<1>(lane, of);
    } else if (of.dimensions == 2) {
      solve<2>(lane, of);
    } else {
      solve<3>(lane, of);
    }
  }

 private:
  template <int Dimensions, class Lane>
  static APSIS_FORMULA void solve(const Lane& lane, const arguments& of) {
    using namespace scalar;
    const lane_group<Lane> group{lane, lane.shared()};
    const int cell = of.stage.cell_of(group);
    double* u = of.stage.u + cell * of.stage.stride;
    const fluid_state state = state_of<Dimensions>(group, of, u);
    const bool by_formula = state.admissible() && has_formula<Dimensions>(of, state),
               by_newton = state.admissible() && !by_formula && state.rho >= dense_enough;
    functions_of_directions along{Dimensions, {}, {}};
    double* values[Dimensions];
    double* free = lane.shared() + most_totals * lane.count() + group.group() * of.points;
    const double height = state.height(Dimensions);
    for (int k = 0; k < Dimensions; ++k) {
      along.n[k] = of.of[k].n;
      along.g[k] = values[k] = free;
      if (by_formula || by_newton)
        put_gaussian(group, of.of[k], {Dimensions == 1 ? height : 1.0, state.u[k], state.T}, values[k]);
      free += of.of[k].n;
    }
    double factor = Dimensions == 1 ? 1.0 : height;
    const bool found = find_weights<Dimensions>(group, of, state, by_newton, values, factor);
    if (!of.stage.takes(group, by_formula || found)) return;
    const auto weights = of.stage.weights(cell, state.rho, state.T);
    const double* last = along.g[Dimensions - 1];
    const int n = along.n[Dimensions - 1];
    multiply_across_lines(along, factor, [&](int line, double factor_of_line) {
      double* to = u + static_cast<long>(line) * n;
      for (int j = group.place(); j < n; j += octet_length)
        to[j] = collision_stage::solution(weights, to[j], factor_of_line * last[j]);
    });
  }

  /// From the moments of a row, as kinetic_moments().
  template <int Dimensions, class Group>
  static APSIS_FORMULA fluid_state state_of(const Group& group, const arguments& of, const double* u) {
    using namespace scalar;
    double omega[Dimensions + 2];
    if (Dimensions == 1 && of.uniform != 0) {
      const auto sums = moments_of_row<halvings_of_line>(group, u, of.of[0].v, of.functions, of.of[0].n);
      omega[0] = of.weight * sums.mass;
      omega[1] = of.weight * sums.momentum;
      omega[2] = of.weight * sums.energy;
    } else {
      sum_over_grid<Dimensions>(group, of, u, omega);
    }
    return to_fluid_state(omega, Dimensions);
  }

  template <int Dimensions, class Group>
  static APSIS_FORMULA void sum_over_grid(const Group& group, const arguments& of, const double* u,
                                          double* omega) {
    using namespace scalar;
    constexpr int last = Dimensions - 1, functions = Dimensions > 1 ? Dimensions + 1 : 1;
    const direction& along = of.of[last];
    int lines = 1;
    for (int k = 0; k < last; ++k) lines *= of.of[k].n;
    sums_of_powers<double> sums[functions];
    if (Dimensions == 1)
      sums[0] = powers_on_line<sums_of_powers<double>>(group, {along.n, along.v, along.weights}, 0.0,
                                                       row_of_line<Group>{group, u});
    else
      sum_powers<functions, halvings>(group, {u, along.n, lines, of.functions}, along.v, along.weights, 0.0,
                                      sums);
    double mine[3 + functions - 1];
    for (int p = 0; p < 3; ++p) mine[p] = sums[0].of[p];
    for (int k = 1; k < functions; ++k) mine[2 + k] = sums[k].of[0];
    group.totals(mine);
    omega[0] = of.weight * mine[0];
    for (int k = 0; k < last; ++k) omega[1 + k] = of.weight * mine[3 + k];
    omega[Dimensions] = of.weight * mine[1];
    omega[Dimensions + 1] = of.weight * energy_of_grid(mine[2], functions > 1 ? mine[functions + 1] : 0.0);
  }

  /// Whether the equilibrium of an admissible state is the formula.
  template <int Dimensions>
  static APSIS_FORMULA bool has_formula(const arguments& of, const fluid_state& state) {
    bool exact = of.uniform != 0 && of.closed_forms != none;
    for (int k = 0; k < Dimensions; ++k)
      exact = exact && scalar::gaussian_has_exact_moments(of.of[k].spacing, of.of[k].max,
                                                          {state.rho, state.u[k], state.T});
    return exact || of.closed_forms == all;
  }

  /// values ← a Gaussian, as gaussians_on().
  template <class Group>
  static APSIS_FORMULA void put_gaussian(const Group& group, const direction& of,
                                         const scalar::gaussian_of_line& curve, double* values) {
    using namespace scalar;
    const auto put = [&](int j, double e) { group.store(e, of.n - j, values + j); };
    if (of.even != 0) return gaussian_on_line(group, {of.n, of.spacing}, curve, put);
    for (int j = 0; j < of.n; j += octet_length)
      put(j, gaussian_start(curve.a, group.load(of.v + j, of.n - j) - curve.u, curve.per()));
  }

  /// Newton's method in the cells that need it, as nearby_maxwellian(). Returns whether it has found the
  /// weights of this cell, and sets the factor of their product then. All lanes of a block take part.
  template <int Dimensions, class Group>
  static APSIS_FORMULA bool find_weights(const Group& group, const arguments& of, const fluid_state& state,
                                         bool wanted, double* const* values, double& factor) {
    using namespace scalar;
    auto newton = nearby_newton::start(Dimensions, state.T);
    for (int k = 0; k < Dimensions; ++k)
      newton.of[k].set_ends(of.of[k].v[0] - state.u[k], of.of[k].v[of.of[k].n - 1] - state.u[k]);
    bool first = true, running = wanted;
    while (group.any_of_block(running)) {  // behind it the weights are there for all lanes
      for (int k = 0; k < Dimensions; ++k) {
        const line_points line{of.of[k].n, of.of[k].v, of.of[k].weights};
        double* w = values[k];
        sums_of_six_powers<double> sums;
        if (running && first)
          sums = powers_on_line<sums_of_six_powers<double>>(group, line, state.u[k],
                                                            row_of_line<Group>{group, w});
        if (running && !first)
          sums = powers_on_line<sums_of_six_powers<double>>(
              group, line, state.u[k], changed_row_of_line<Group>{group, w, newton.beta[k], newton.gamma});
        group.totals(sums.of);
        if (running)
          for (int p = 0; p < 6; ++p) newton.of[k].sums[p] = sums.of[p];
      }
      first = false;
      running = running && newton.advance();
    }
    if (newton.found) factor = state.rho / (of.weight * newton.mass());
    return newton.found;
  }
};

}  // namespace apsis::kernels
