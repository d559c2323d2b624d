#pragma once

#include <apsis/device/internal/lane_group.hpp>
#include <apsis/model/formulas/grid_sums.hpp>
#include <apsis/model/formulas/reduction.hpp>
#include <apsis/model/formulas/velocity_grid.hpp>

namespace apsis::kernels {

/// Rows of a gas on the product of one to three velocity lines. A row is f, or (g, h) if molecules have
/// more degrees of freedom than the grid has dimensions (model/gas.hpp). All pointers are in the memory of
/// the device.
struct gas_rows {
  static constexpr int halvings = 12;  ///< levels at which sums over lines are halved
  static constexpr int most_lines = scalar::longest_chain_of_lines << halvings;  ///< their largest number
  static constexpr int halvings_of_line = 4;  ///< levels at which sums along a line are halved
  static constexpr int most_velocities_of_line = scalar::longest_chain_of_line
                                                 << halvings_of_line;  ///< their largest number

  /// Velocities of a direction.
  struct direction {
    const double *v,      ///< velocities
        *weights;         ///< weights of the quadrature; nullptr: all are 1
    int n,                ///< number of velocities
        even;             ///< whether they are evenly spaced
    double spacing, max;  ///< Δv and the end of an evenly spaced line

    APSIS_FORMULA scalar::variances variances_at(double u) const {
      return even != 0 ? scalar::variances_at(v, n, spacing, u) : scalar::variances_at(v, n, u);
    }
  };

  direction of[3];          ///< each direction
  const double *functions,  ///< velocity_grid::functions_of_lines(), or ½v² of an even line
      *weights;             ///< weights of all velocities; nullptr: all are 1
  int dimensions,           ///< 1, 2 or 3
      degrees,              ///< degrees of freedom
      size,                 ///< number of velocities
      points,               ///< sum of the points of all directions
      uniform;              ///< whether all directions are evenly spaced
  double weight;            ///< weight of the sums

  /// Whether a row is (g, h).
  APSIS_FORMULA bool reduced() const { return degrees > dimensions; }

  /// ω ← the moments of a row, as gas::moments(). All lanes of the block take part, eight for each row.
  template <int Dimensions, class Group>
  APSIS_FORMULA void moments(const Group& group, const double* row, double* omega) const {
    using namespace scalar;
    if (Dimensions == 1 && uniform != 0) {
      const auto sums = moments_of_row<halvings_of_line>(group, row, of[0].v, functions, of[0].n);
      omega[0] = weight * sums.mass;
      omega[1] = weight * sums.momentum;
      omega[2] = weight * sums.energy;
    } else {
      moments_of_grid<Dimensions>(group, row, omega);
    }
    if (reduced()) omega[Dimensions + 1] += 0.5 * mass<Dimensions>(group, row + size);
  }

  /// Returns the entropy of a row as gas::entropy() does, without the weight of the sums.
  template <class Group>
  APSIS_FORMULA double entropy(const Group& group, const double* row) const {
    return scalar::entropy_of_row(group, weights, row, reduced() ? row + size : nullptr,
                                  0.5 * (degrees - dimensions), size);
  }

  /// Returns the state of ω, as gas::state() does.
  template <int Dimensions>
  APSIS_FORMULA fluid_state state(const double* omega) const {
    return reduced() ? scalar::reduced_gas{Dimensions, degrees}.state(omega)
                     : to_fluid_state(omega, Dimensions);
  }

  /// c ← the components of v − u across a line along the last direction.
  template <int Dimensions>
  APSIS_FORMULA void components_across(int line, const double* u, double* c) const {
    if constexpr (Dimensions == 2) c[0] = of[0].v[line] - u[0];
    if constexpr (Dimensions == 3) {
      c[0] = of[0].v[line / of[1].n] - u[0];
      c[1] = of[1].v[line % of[1].n] - u[1];
    }
  }

 private:
  template <int Dimensions>
  APSIS_FORMULA int lines() const {
    int all = 1;
    for (int k = 0; k < Dimensions - 1; ++k) all *= of[k].n;
    return all;
  }

  /// sums[f] ← the sums of powers along the last direction, over lines weighted by function f < Functions.
  template <int Dimensions, int Functions, class Group>
  APSIS_FORMULA void sum(const Group& group, const double* row, scalar::sums_of_powers<double>* sums) const {
    using namespace scalar;
    const direction& last = of[Dimensions - 1];
    if (Dimensions == 1)
      sums[0] = powers_on_line<sums_of_powers<double>>(group, {last.n, last.v, last.weights}, 0.0,
                                                       row_of_line<Group>{group, row});
    else
      sum_powers<Functions, halvings>(group, {row, last.n, lines<Dimensions>(), functions}, last.v,
                                      last.weights, 0.0, sums);
  }

  template <int Dimensions, class Group>
  APSIS_FORMULA void moments_of_grid(const Group& group, const double* row, double* omega) const {
    constexpr int across = Dimensions > 1 ? Dimensions + 1 : 1, last = Dimensions - 1;
    scalar::sums_of_powers<double> sums[across];
    sum<Dimensions, across>(group, row, sums);
    double mine[3 + across - 1];
    for (int p = 0; p < 3; ++p) mine[p] = sums[0].of[p];
    for (int k = 1; k < across; ++k) mine[2 + k] = sums[k].of[0];
    group.totals(mine);
    omega[0] = weight * mine[0];
    for (int k = 0; k < last; ++k) omega[1 + k] = weight * mine[3 + k];
    omega[Dimensions] = weight * mine[1];
    omega[Dimensions + 1] = weight * scalar::energy_of_grid(mine[2], across > 1 ? mine[across + 1] : 0.0);
  }

  /// Returns the mass of a row, as kinetic_mass() does.
  template <int Dimensions, class Group>
  APSIS_FORMULA double mass(const Group& group, const double* row) const {
    scalar::sums_of_powers<double> sums[1];
    sum<Dimensions, 1>(group, row, sums);
    return weight * group.total(sums[0].of[0]);
  }
};

/// The number of dimensions as a constant.
template <int Dimensions>
struct dimension_constant {
  static constexpr int value = Dimensions;
};
/// Calls body with this constant.
template <class Body>
APSIS_FORMULA void with_dimensions(int dimensions, const Body& body) {
  if (dimensions == 1) {
    body(dimension_constant<1>());
  } else if (dimensions == 2) {
    body(dimension_constant<2>());
  } else {
    body(dimension_constant<3>());
  }
}

}  // namespace apsis::kernels
