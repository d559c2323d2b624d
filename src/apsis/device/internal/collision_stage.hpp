#pragma once

#include <apsis/core/relaxation_weights.hpp>
#include <apsis/device/internal/lane_group.hpp>
#include <apsis/model/formulas/reduction.hpp>
#include <apsis/model/formulas/relaxation.hpp>

namespace apsis::kernels {

/// A stage u ← v, v = u + a Q(v)/ε + b Q̇(v)/ε², in every cell. This part does not depend on the velocity
/// grid. Cells whose equilibrium the kernel does not find remain unchanged and are marked.
struct collision_stage {
  double* u;                       ///< rows of all cells
  double* marks;                   ///< mark of every cell: 1 if the cell remains unchanged, else 0
  const double* epsilon;           ///< ε of every cell
  long stride;                     ///< numbers of a row
  int first, last;                 ///< cells first … last − 1
  int by_viscosity;                ///< whether C is `rate` instead of 1
  scalar::rate_by_viscosity rate;  ///< the rate from a viscosity
  double a, b;                     ///< a ≥ 0, b ≤ 0

  /// Returns the cell of a group. Groups beyond the last cell get the last one, because all lanes take part
  /// in the sums.
  template <class Group>
  APSIS_FORMULA int cell_of(const Group& group) const {
    const int number = first + group.number_in_launch();
    return number < last ? number : last - 1;
  }
  /// Marks the cell of a group; `by_formula` states that the kernel can solve it. Returns whether the group
  /// has to solve it.
  template <class Group>
  APSIS_FORMULA bool takes(const Group& group, bool by_formula) const {
    const int number = first + group.number_in_launch();
    if (number >= last) return false;
    if (group.place() == 0) marks[number] = by_formula ? 0.0 : 1.0;
    return by_formula;
  }

  /// Returns the weights of a cell with density ρ > 0 and temperature T.
  APSIS_FORMULA relaxation_weights<double> weights(int cell, double rho, double T) const {
    return relax_weights(a, b, rate_of(rho, T), epsilon[cell]);
  }
  /// Returns the coefficients of the stage of a cell with density ρ > 0 and temperature T.
  APSIS_FORMULA stage_coefficients coefficients(int cell, double rho, double T) const {
    return coefficients_of_stage(a, b, rate_of(rho, T), epsilon[cell]);
  }
  /// Returns the solution from u and the equilibrium e.
  static APSIS_FORMULA double solution(const relaxation_weights<double>& weights, double u, double e) {
    return weights.of_e <= weights.of_u ? scalar::moved_towards(u, weights.of_e, e)
                                        : scalar::moved_towards(e, weights.of_u, u);
  }

 private:
  APSIS_FORMULA double rate_of(double rho, double T) const {
    return by_viscosity != 0 ? rate.of(rho, T) : 1.0;
  }
};

}  // namespace apsis::kernels
