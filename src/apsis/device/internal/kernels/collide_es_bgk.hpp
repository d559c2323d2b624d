#pragma once

#include <apsis/device/internal/central_sums.hpp>
#include <apsis/device/internal/collision_stage.hpp>
#include <apsis/device/internal/correlated_rows.hpp>
#include <apsis/device/internal/target_of_cell.hpp>
#include <apsis/model/formulas/ellipsoidal.hpp>

namespace apsis::kernels {

/// Solves stages of the ellipsoidal model, as `collide` does. The target is a Gaussian with correlated
/// components times a quadratic polynomial. Moments of the Gaussian determine the polynomial, so that the
/// target has its required moments.
///
/// The host solves cells where this correction fails, or where tails are cut off.
struct collide_es_bgk {
  static constexpr const char* name = "collide_es_bgk";  ///< name of the kernel
  static constexpr int degree = 4;                       ///< degree of the central sums

  /// Arguments.
  struct arguments {
    collision_stage stage;            ///< stage of all cells
    gas_rows rows;                    ///< rows of the gas
    scalar::ellipsoidal_model model;  ///< parameter of the model
    double* room;                     ///< numbers_of_room() for each cell of a launch
    int cuts_tails;                   ///< whether to cut off tails that would make a solution negative
  };

  /// Returns how many numbers of `room` a cell needs: for the Gaussian, its tables, and planes of
  /// central sums.
  static constexpr APSIS_FORMULA long numbers_of_room(const gas_rows& rows) {
    return rows.size + correlated_rows<3>::numbers_of_tables(rows) +
           memory_of_central_sums::planes_of(rows, degree);
  }

  /// Solves the stage of a cell together with seven other lanes. The block has shared memory for most_totals
  /// numbers per lane and memory_of_central_sums::powers_of() numbers per cell.
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
    double omega[Dimensions + 2];
    rows.moments<Dimensions>(group, u, omega);
    const fluid_state state = rows.state<Dimensions>(omega);
    double* base = of.room + group.number_in_launch() * numbers_of_room(rows);
    double* tables = base + rows.size;
    const central_summation<Dimensions, degree, lane_group<Lane>> sums{
        group,
        rows,
        state.u,
        {lane.shared() + most_totals * lane.count() +
             group.group() * memory_of_central_sums::powers_of(rows, degree),
         tables + correlated_rows<3>::numbers_of_tables(rows)}};
    sums.start();
    const auto coefficients = of.stage.coefficients(cell, state.rho, state.T);
    double deviations[Dimensions * (Dimensions + 1) / 2];
    find_deviations<Dimensions>(sums.template sum<2>(u), state, of.model.decay(coefficients), deviations);
    auto target = ellipsoidal_target<Dimensions>::of(of.model, state, deviations,
                                                     of.model.weight_of_derivative(coefficients), 1.0,
                                                     rows.degrees - Dimensions);
    correlated_rows<Dimensions>::put(group, rows, state, target.covariance, target.inverse, tables, base);
    const auto of_base = sums.template sum<degree>(base);
    const bool known = state.admissible() && target.exists &&
                       is_wide_enough<Dimensions>(rows, state, target.shape.variance) &&
                       (!rows.reduced() || target.others > 0.0) &&
                       moments_of_base<Dimensions, decltype(of_base)>{
                           of_base, {state.rho, target.others, rows.degrees * state.T}}
                           .correct(target.shape);
    const stored_base stored{rows.of[Dimensions - 1].n, rows.size / rows.of[Dimensions - 1].n, base,
                             target.others};
    const target_of_cell<Dimensions, false, stored_base> values{rows, stored, target.shape, state.u};
    finish_stage(group, of.stage, cell, state, of.cuts_tails != 0, known, values, u);
  }

  /// to ← Θ_kl − T δ_kl for k ≤ l at the end of the stage.
  template <int Dimensions, class Sums>
  static APSIS_FORMULA void find_deviations(const Sums& g, const fluid_state& state, double decay,
                                            double* to) {
    for (int k = 0; k < Dimensions; ++k)
      for (int l = k; l < Dimensions; ++l)
        *to++ = (g.second(k, l) / state.rho - (k == l ? state.T : 0.0)) * decay;
  }
};

}  // namespace apsis::kernels
