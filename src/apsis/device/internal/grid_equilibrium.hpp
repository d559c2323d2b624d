#pragma once

#include <apsis/device/internal/gas_rows.hpp>
#include <apsis/model/fluid_state.hpp>
#include <apsis/model/formulas/nearby.hpp>
#include <apsis/model/line_moments.hpp>

namespace apsis::kernels {

/// The cells whose equilibrium is a closed formula.
enum class equilibrium_formulas {
  none,         ///< no cell
  where_exact,  ///< cells where the formula has exact moments
  all           ///< all cells
};

/// Calls put(first velocity, value) for the octets of a Gaussian, as velocity_rows::gaussians() does.
template <class Group, class Put>
APSIS_FORMULA void gaussian_on_line(const Group& group, const scalar::spaced_line& line,
                                    const scalar::gaussian_of_line& curve, const Put& put) {
  using namespace scalar;
  if (!walks_outwards(line, curve)) return gaussian_by_octets(group, line, curve, put);
  const double per = curve.per();
  const double centre =
      gaussian_vector(curve.u, line.spacing, double(line.n), double(octet_length), double(line.octets()));
  const double x = distances_of_octet(group, line, curve.u, centre);
  const double right = gaussian_right(x, per, line.jump()), change = gaussian_change(per, line.jump());
  walk_outwards(gaussian_outwards<double>{gaussian_start(curve.a, x, per), right, change / right, change},
                static_cast<int>(centre), line, curve, put);
}

/// values ← a Gaussian on a line, as gaussians_on().
template <class Group>
APSIS_FORMULA void put_gaussian(const Group& group, const gas_rows::direction& of,
                                const scalar::gaussian_of_line& curve, double* values) {
  using namespace scalar;
  const auto put = [&](int j, double e) { group.store(e, of.n - j, values + j); };
  if (of.even != 0) return gaussian_on_line(group, {of.n, of.spacing}, curve, put);
  for (int j = 0; j < of.n; j += octet_length)
    put(j, gaussian_start(curve.a, group.load(of.v + j, of.n - j) - curve.u, curve.per()));
}

/// The equilibrium of a cell as a product of one function along each direction. It is a Gaussian, or the
/// weights next to it that Newton's method finds.
template <int Dimensions>
struct grid_equilibrium {
  fluid_state of_g;                       ///< state of g alone
  double others;                          ///< h/g
  scalar::functions_of_directions along;  ///< the functions
  double factor;                          ///< factor of the product
  bool found;                             ///< whether the other members are the equilibrium
  line_moments moments;                   ///< moments of the product, if known

  /// Finds the equilibrium of moments ω with the state s, together with the other lanes of the block. `free`
  /// is shared memory for gas_rows::points numbers. Other lanes may read the functions after the next wait.
  template <class Group>
  APSIS_FORMULA void find(const Group& group, const gas_rows& rows, equilibrium_formulas closed_forms,
                          const double* omega, const fluid_state& s, double* free) {
    const bool exists = set_state(rows, omega, s), exact = exists && has_exact_moments(rows),
               by_formula = exists && ((exact && closed_forms != equilibrium_formulas::none) ||
                                       closed_forms == equilibrium_formulas::all),
               by_newton = exists && !by_formula && of_g.rho >= scalar::dense_enough;
    double* values[Dimensions];
    const double height = of_g.height(Dimensions);
    along.dimensions = Dimensions;
    for (int k = 0; k < Dimensions; ++k) {
      along.n[k] = rows.of[k].n;
      along.g[k] = values[k] = free;
      if (by_formula || by_newton)
        put_gaussian(group, rows.of[k], {Dimensions == 1 ? height : 1.0, of_g.u[k], of_g.T}, values[k]);
      free += rows.of[k].n;
    }
    factor = Dimensions == 1 ? 1.0 : height;
    moments.known = false;
    if (by_formula && exact) moments.set_gaussian(of_g.T);
    found = find_weights(group, rows, by_newton, values) || by_formula;
    moments.others = others;
  }

 private:
  /// Sets the state of g and h/g, for (g, h) as in gas::moments_of_g(). Returns whether the equilibrium may
  /// be a Gaussian.
  APSIS_FORMULA bool set_state(const gas_rows& rows, const double* omega, const fluid_state& s) {
    of_g = s;
    others = 0.0;
    if (rows.reduced()) {
      const auto parts = scalar::reduced_gas{Dimensions, rows.degrees}.parts(
          omega, s, [&](int k) { return rows.of[k].variances_at(s.u[k]); });
      double moments_of_g[Dimensions + 2];
      for (int k = 0; k <= Dimensions; ++k) moments_of_g[k] = omega[k];
      moments_of_g[Dimensions + 1] = parts.of_g;
      of_g = to_fluid_state(moments_of_g, Dimensions);
      others = parts.others;
    }
    return others == others && of_g.admissible();
  }

  /// Whether the formula has exact moments, as formula_has_exact_moments().
  APSIS_FORMULA bool has_exact_moments(const gas_rows& rows) const {
    bool exact = rows.uniform != 0;
    for (int k = 0; k < Dimensions; ++k)
      exact = exact && scalar::gaussian_has_exact_moments(rows.of[k].spacing, rows.of[k].max,
                                                          {of_g.rho, of_g.u[k], of_g.T});
    return exact;
  }

  /// Runs Newton's method in the cells that need it, as nearby_maxwellian(). Returns whether it has found
  /// the weights of this cell; if so, sets the factor and the moments of their product. All lanes of a block
  /// take part.
  template <class Group>
  APSIS_FORMULA bool find_weights(const Group& group, const gas_rows& rows, bool wanted,
                                  double* const* values) {
    using namespace scalar;
    auto newton = nearby_newton<double>::start(Dimensions, of_g.T, __builtin_sqrt(of_g.T));
    for (int k = 0; k < Dimensions; ++k)
      newton.of[k].set_ends(rows.of[k].v[0] - of_g.u[k], rows.of[k].v[rows.of[k].n - 1] - of_g.u[k]);
    bool first = true, running = wanted;
    while (group.any_of_block(running)) {  // after the loop all lanes may read the weights
      for (int k = 0; k < Dimensions; ++k) {
        const line_points line{rows.of[k].n, rows.of[k].v, rows.of[k].weights};
        double* w = values[k];
        sums_of_six_powers<double> sums;
        if (running && first)
          sums = powers_on_line<sums_of_six_powers<double>>(group, line, of_g.u[k],
                                                            row_of_line<Group>{group, w});
        if (running && !first)
          sums = powers_on_line<sums_of_six_powers<double>>(
              group, line, of_g.u[k], changed_row_of_line<Group>{group, w, newton.beta[k], newton.gamma});
        group.totals(sums.of);
        if (running)
          for (int p = 0; p < 6; ++p) newton.of[k].sums[p] = sums.of[p];
      }
      first = false;
      running = running && newton.advance();
    }
    if (!(newton.found > 0.0)) return false;
    factor = of_g.rho / (rows.weight * newton.mass());
    moments.known = true;
    for (int k = 0; k < Dimensions; ++k)
      for (int p = 0; p < 6; ++p) moments.of[k][p] = newton.of[k].sums[p] / newton.of[k].sums[0];
    return true;
  }
};

}  // namespace apsis::kernels
