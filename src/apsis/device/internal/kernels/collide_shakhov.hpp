#pragma once

#include <apsis/device/internal/central_sums.hpp>
#include <apsis/device/internal/collision_stage.hpp>
#include <apsis/device/internal/grid_equilibrium.hpp>
#include <apsis/device/internal/target_of_cell.hpp>
#include <apsis/model/formulas/shakhov.hpp>

namespace apsis::kernels {

/// Solves stages of the Shakhov model, as `collide` does. The target is the equilibrium times a polynomial.
/// Moments of the equilibrium correct the polynomial, so that the target has its required moments.
///
/// The host solves cells where these moments are unknown, where the correction fails, or where tails are
/// cut off.
struct collide_shakhov {
  static constexpr const char* name = "collide_shakhov";  ///< name of the kernel
  static constexpr int degree = 3;                        ///< degree of the central sums

  /// Arguments.
  struct arguments {
    collision_stage stage;              ///< stage of all cells
    gas_rows rows;                      ///< rows of the gas
    scalar::shakhov_target target;      ///< target of the model
    double* room;                       ///< numbers_of_room() for each cell of a launch
    equilibrium_formulas closed_forms;  ///< which equilibria are formulas
    int cuts_tails;                     ///< whether to cut off tails that would make a solution negative
  };

  /// Returns how many numbers of `room` a cell needs, for planes of central sums.
  static constexpr APSIS_FORMULA long numbers_of_room(const gas_rows& rows) {
    return memory_of_central_sums::planes_of(rows, degree);
  }

  /// Solves the stage of a cell together with seven other lanes. The block has shared memory for most_totals
  /// numbers per lane, and for gas_rows::points and memory_of_central_sums::powers_of() numbers per cell.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    with_dimensions(of.rows.dimensions,
                    [&](auto dimensions) APSIS_INLINED { solve<decltype(dimensions)::value>(lane, of); });
  }

 private:
  template <int Dimensions, class Lane>
  static APSIS_FORMULA void solve(const Lane& lane, const arguments& of) {
    using namespace scalar;
    const gas_rows& rows = of.rows;
    const lane_group<Lane> group{lane, lane.shared()};
    const int cell = of.stage.cell_of(group);
    double* u = of.stage.u + cell * of.stage.stride;
    double omega[Dimensions + 2], heat[3] = {};
    rows.moments<Dimensions>(group, u, omega);
    const fluid_state state = rows.state<Dimensions>(omega);
    double* free = lane.shared() + most_totals * lane.count() +
                   group.group() * (rows.points + memory_of_central_sums::powers_of(rows, degree));
    find_heat<Dimensions>(group, rows, state, u,
                          {free + rows.points, of.room + group.number_in_launch() * numbers_of_room(rows)},
                          heat);
    grid_equilibrium<Dimensions> m;
    m.find(group, rows, of.closed_forms, omega, state, free);
    const auto coefficients = of.stage.coefficients(cell, state.rho, state.T);
    for (double& q : heat) q *= of.target.decay(coefficients);
    target_shape shape =
        of.target.shape(Dimensions, state, heat, of.target.weight_of_derivative(coefficients), 1.0);
    const bool known = m.found && m.moments.known && state.admissible() &&
                       is_wide_enough<Dimensions>(rows, state, shape.variance) &&
                       moments_of_product<Dimensions>(m.moments).correct(shape);
    const product_base<Dimensions> base{m};
    const target_of_cell<Dimensions, true, product_base<Dimensions>> target{rows, base, shape, state.u};
    finish_stage(group, of.stage, cell, state, of.cuts_tails != 0, known, target, u);
  }

  /// heat ← the heat flux of a row, as compute_central_moments().
  template <int Dimensions, class Group>
  static APSIS_FORMULA void find_heat(const Group& group, const gas_rows& rows, const fluid_state& state,
                                      const double* row, const memory_of_central_sums& memory, double* heat) {
    const central_summation<Dimensions, degree, Group> summation{group, rows, state.u, memory};
    summation.start();
    const auto g = summation.template sum<3>(row);
    const auto third = [&](int k, int l) APSIS_INLINED { return g.third(k, l); };
    if (rows.reduced()) {
      const auto h = summation.template sum<1>(row + rows.size);
      scalar::find_heat_flux(Dimensions, third, [&](int k) APSIS_INLINED { return h.first(k); }, heat);
    } else {
      scalar::find_heat_flux(Dimensions, third, [](int) APSIS_INLINED { return 0.0; }, heat);
    }
  }
};

}  // namespace apsis::kernels
