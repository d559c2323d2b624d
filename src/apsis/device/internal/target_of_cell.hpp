#pragma once

#include <apsis/device/internal/collision_stage.hpp>
#include <apsis/device/internal/grid_equilibrium.hpp>
#include <apsis/model/formulas/target_moments.hpp>
#include <apsis/velocity/widest_gap.hpp>

namespace apsis::kernels {

/// Whether targets of a cell may have a base of this variance, as in conservative_target().
template <int Dimensions>
APSIS_FORMULA bool is_wide_enough(const gas_rows& rows, const fluid_state& state, double variance) {
  double widest = 0.0;
  const double width = __builtin_sqrt(state.T);
  for (int k = 0; k < Dimensions; ++k) {
    const auto& of = rows.of[k];
    const double gap = of.even != 0
                           ? of.spacing
                           : widest_gap(of.v, of.n, of.spacing, state.u[k] - width, state.u[k] + width);
    if (widest < gap) widest = gap;
  }
  return variance >= scalar::narrowest_target * (widest * widest);
}

/// A product of functions along lines as the base of a target.
template <int Dimensions>
struct product_base {
  const grid_equilibrium<Dimensions>& m;  ///< the product

  APSIS_FORMULA double others() const { return m.others; }  ///< h/g
  /// Calls put(line, g) for every line along the last direction; g(j) is the value at point j.
  template <class Put>
  APSIS_FORMULA void for_each_line(const Put& put) const {
    const double* values = m.along.g[Dimensions - 1];
    scalar::multiply_across_lines(m.along, m.factor, [&](int line, double factor) APSIS_INLINED {
      put(line, [&](int j) APSIS_INLINED { return factor * values[j]; });
    });
  }
};

/// A row in memory as the base of a target.
struct stored_base {
  int n, lines;         ///< points of a line, number of lines
  const double* g;      ///< the row
  double others_per_g;  ///< h/g

  APSIS_FORMULA double others() const { return others_per_g; }  ///< h/g
  /// Calls put(line, g) as product_base does.
  template <class Put>
  APSIS_FORMULA void for_each_line(const Put& put) const {
    for (int line = 0; line < lines; ++line) {
      const double* row = g + static_cast<long>(line) * n;
      put(line, [&](int j) APSIS_INLINED { return row[j]; });
    }
  }
};

/// The target of a cell: the base times a polynomial for g, and one for h. `Cubic`: these have terms of
/// third degree.
template <int Dimensions, bool Cubic, class Base>
struct target_of_cell {
  const gas_rows& rows;       ///< rows of the gas
  const Base& base;           ///< factor of the polynomials
  const target_shape& shape;  ///< polynomials
  const double* u;            ///< bulk velocity

  /// Calls apply(component, value) for the components of this lane of a group of eight.
  template <class Group, class Apply>
  APSIS_FORMULA void for_each(const Group& group, const Apply& apply) const {
    using namespace scalar;
    constexpr int along = Dimensions - 1;
    const int across[] = {0, 1};
    const auto& last = rows.of[along];
    base.for_each_line([&](int line, const auto& g) APSIS_INLINED {
      double c[2];
      rows.components_across<Dimensions>(line, u, c);
      const auto of_g = polynomial_on_line<Dimensions, Cubic>(shape.of_g, across, along, c),
                 of_h = polynomial_on_line<Dimensions, Cubic>(shape.of_h, across, along, c);
      for (int j = group.place(); j < last.n; j += octet_length) {
        const long component = static_cast<long>(line) * last.n + j;
        const double m = g(j), c_along = last.v[j] - u[along];
        apply(component, m * of_g(c_along));
        if (rows.reduced()) apply(rows.size + component, base.others() * m * of_h(c_along));
      }
    });
  }
};

/// Solves the stage of a cell with this target. Leaves the cell to the host if the target is not `known`, or
/// if a tail would have to be cut off.
template <class Group, class Target>
APSIS_FORMULA void finish_stage(const Group& group, const collision_stage& stage, int cell,
                                const fluid_state& state, bool cuts_tails, bool known, const Target& target,
                                double* u) {
  const auto weights = stage.weights(cell, state.rho, state.T);
  const double keep = kept_part(weights);
  const bool bounded = cuts_tails && keep < __builtin_inf();
  double raised = 0.0;
  if (bounded && known)
    target.for_each(
        group, [&](long j, double e) APSIS_INLINED { raised += scalar::raise(e, keep, u[j]) ? 1.0 : 0.0; });
  const bool cut = group.total(raised) > 0.0;
  if (!stage.takes(group, known && !cut)) return;
  target.for_each(group, [&](long j, double e) APSIS_INLINED {
    if (bounded) scalar::raise(e, keep, u[j]);
    u[j] = collision_stage::solution(weights, u[j], e);
  });
}

}  // namespace apsis::kernels
