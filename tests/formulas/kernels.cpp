// Kernels of a graphics processor with formulas of all families on a double. test_formulas.py only compiles
// them to assembly, without any library.
#include <apsis/boundary/formulas/continuation.hpp>
#include <apsis/model/formulas/arithmetic.hpp>
#include <apsis/model/formulas/correlated.hpp>
#include <apsis/model/formulas/ellipsoidal.hpp>
#include <apsis/model/formulas/grid_sums.hpp>
#include <apsis/model/formulas/line.hpp>
#include <apsis/model/formulas/nearby.hpp>
#include <apsis/model/formulas/plane.hpp>
#include <apsis/model/formulas/reduction.hpp>
#include <apsis/model/formulas/relaxation.hpp>
#include <apsis/model/formulas/shakhov.hpp>
#include <apsis/model/formulas/target.hpp>
#include <apsis/model/formulas/target_moments.hpp>
#include <apsis/model/formulas/velocity.hpp>
#include <apsis/model/formulas/velocity_grid.hpp>
#include <apsis/model/formulas/velocity_line.hpp>
#include <apsis/scheme/formulas/quartic.hpp>
#include <apsis/scheme/formulas/row.hpp>
#include <apsis/scheme/formulas/teno5.hpp>
#include <apsis/scheme/formulas/upwind.hpp>
#include <apsis/scheme/formulas/weno5_js.hpp>
#include <apsis/scheme/formulas/weno5_z.hpp>
#include <apsis/semidiscrete/formulas/centre.hpp>
#include <apsis/semidiscrete/formulas/collision.hpp>
#include <apsis/semidiscrete/formulas/cut_cell.hpp>
#include <apsis/semidiscrete/formulas/face.hpp>
#include <apsis/semidiscrete/formulas/lattice.hpp>
#include <apsis/semidiscrete/formulas/rotation.hpp>
#include <apsis/semidiscrete/formulas/upwind.hpp>
#include <apsis/steady/formulas/mixture.hpp>
#include <apsis/steady/formulas/sweep.hpp>

namespace scalar = apsis::scalar;

namespace {

template <class Weights>
double outflow_edge(const double* u) {
  using namespace scalar::weno5;
  const window<Weights, double> at(u[0], u[1], u[2], u[3], u[4]);
  right_fraction<double> cell(edge_terms<Weights, double>{at});
  if constexpr (!Weights::of_any_size)
    cell.replace_if_too_large(right_fraction<double>(edge_terms<scaled<Weights>, double>(at)));
  return cell.edge();
}

}  // namespace

/// One of eight lanes. Its sums are its own numbers.
struct one_of_eight {
  using number = double;
  int place;
  double load(const double* from) const { return from[place]; }
  double load_once(const double* from) const { return from[place]; }
  double load(const double* from, int count) const { return place < count ? from[place] : 0.0; }
  double first(double mine, int count) const { return place < count ? mine : 0.0; }
  void store(double mine, int count, double* to) const {
    if (place < count) to[place] = mine;
  }
  double numbers() const { return place; }
  double total(double mine) const { return mine; }
};

extern "C" void line(const double* f, const double* v, int n, double* to) {
  const one_of_eight group{3};
  scalar::moments_of_line sums;
  scalar::sum_moments<1>(group, f, 0, v, v, n, &sums);
  const auto state = scalar::state_of_line::of(sums.mass, sums.momentum, sums.energy);
  const scalar::spaced_line line{n, v[1]};
  const scalar::gaussian_of_line of{state.height(), state.u, state.T};
  const auto put = [&](int k, double value) { to[k] = value; };
  if (!state.admissible() || !scalar::gaussian_has_exact_moments(v[1], v[0], state)) return;
  if (scalar::walks_outwards(line, of))
    scalar::walk_outwards(scalar::gaussian_outwards<double>{f[0], f[1], f[2], f[3]}, 1, line, of, put);
  else
    scalar::gaussian_by_octets(group, line, of, put);
}

extern "C" void grid(const double* f, const double* v, int n, int lines, double* to) {
  const one_of_eight group{3};
  scalar::sums_of_powers<double> powers[4];
  scalar::sum_powers<4, 12>(group, {f, n, lines, v}, v, v, v[0], powers);
  scalar::multiply_across_lines({3, {n, n, n}, {v, v, v}}, powers[1].of[0],
                                [&](int line, double product) { to[line] = product; });
  to[0] = scalar::energy_of_grid(powers[0].of[2], powers[3].of[0]);
}

extern "C" void weights(const double* v, int n, double* w) {
  const one_of_eight group{3};
  auto newton = scalar::nearby_newton<double>::start(1, v[0], v[1]);
  newton.of[0].set_ends(v[0], v[n - 1]);
  auto sums = scalar::powers_on_line<scalar::sums_of_six_powers<double>>(
      group, {n, v, v}, 0.0, scalar::row_of_line<one_of_eight>{group, w});
  for (;;) {
    for (int p = 0; p < 6; ++p) newton.of[0].sums[p] = sums.of[p];
    if (!newton.advance()) break;
    sums = scalar::powers_on_line<scalar::sums_of_six_powers<double>>(
        group, {n, v, v}, 0.0,
        scalar::changed_row_of_line<one_of_eight>{group, w, newton.beta[0], newton.gamma});
  }
  w[0] = newton.mass();
}

extern "C" void transport_z(const double* u, double* acc) {
  const auto first = scalar::unlimited(u[2], outflow_edge<scalar::weights_z>(u), acc[2]);
  const auto here = scalar::limited_after(first, u[3], outflow_edge<scalar::weights_z>(u + 1), acc[2]);
  const auto next = scalar::limited_after(here, u[4], outflow_edge<scalar::weights_z>(u + 2), acc[2]);
  const double in = scalar::limited_flux(first, here), out = scalar::limited_flux(here, next);
  acc[0] = scalar::transported(
      0.5, u[3], 0.1, in - out, false, [acc] { return acc[0]; }, true, 0.2, [acc] { return acc[1]; });
}

extern "C" void linear_edges(const double* u, double* to) {
  to[0] = outflow_edge<scalar::weights_js>(u);
  to[1] = scalar::upwind1_edge(u[0]) + outflow_edge<scalar::weights_teno>(u);
  to[2] = scalar::upwind5_edge(u[0], u[1], u[2], u[3], u[4]);
  scalar::limiter::limit_edges(u[2], to[0], to[2]);
}

extern "C" void powers(const double* u, double* to) {
  to[0] = scalar::square_of(u[0]) + scalar::cube_of(u[1]) + scalar::fourth_power_of(u[2]);
}

extern "C" void boundaries(const double* u, double* to) {
  to[0] = scalar::continuation<double>(u[0], u[1], u[2]).average(2.0);
  to[1] = scalar::if_entering(u[0], u[1], scalar::if_leaving(u[0], u[2]));
  to[2] = scalar::with_entering(to[2], u[0], u[1], u[2], u[3]);
  to[3] = scalar::with_change(to[3], u[0], u[1]);
  to[4] =
      scalar::limited_edge(u[0], u[1], scalar::limited_fraction(u[0], u[1], u[2], u[3], u[4], u[5]), u[6]);
}

extern "C" void rotations(const double* u, double* to) {
  const scalar::rotation_factors factors{u[6], u[7], u[8]};
  const scalar::rotation_edge<double> before{u[9], u[10]}, behind{u[11], u[12]};
  const auto in = scalar::fluxes_of_rotation(before, factors, true, u[0], u[1], u[2], u[3], u[4]),
             out = scalar::fluxes_of_rotation(behind, factors, true, u[1], u[2], u[3], u[4], u[5]);
  to[0] = scalar::fraction_of_rotation(in, out, u[3], u[13]);
  to[1] = in.high_order - out.high_order;
}

extern "C" void cut_cells(const double* u, double* to) {
  scalar::cut_demand<double> demand{u[0], u[1], u[2], u[3]};
  demand.add(u[4], u[5], u[6]);
  to[0] = demand.factor(u[7], u[8]) + demand.steady_factor(u[7], u[9]);
  to[1] = scalar::leaving_value(u[7], to[0] * u[5]) + scalar::nonnegative_leaving_value(u[6], to[0] * u[5]);
}

extern "C" void collisions(const double* u, double* to) {
  const auto points = scalar::quartic_values<true>(u[0], u[1], u[2], u[3], u[4]);
  to[0] = scalar::collision_part(u[0], u[1], u[2], scalar::with_collision(points.g0, points.g1, points.g2));
  to[1] = scalar::with_part(0.0, u[0], u[1], u[2], scalar::moved_towards(u[3], u[4], u[5]));
  to[2] = scalar::relaxation_rate(u[0], u[1], u[2]);
  to[3] = scalar::centre_value<double>([u](int i) { return u[i]; }, true);
  const scalar::changed_cell<double> cell(u[0], u[1]), next(u[1], u[2]);
  to[4] = scalar::centre_average(cell.b, u[5], scalar::centre_flux(cell, next, true), true);
  to[5] = scalar::lowered_centre(u[0], u[1], u[2], true);
}

extern "C" void equilibria(const double* u, double* to) {
  const scalar::cubic_polynomial<double> cubic{u[0], u[1], u[2], u[3]};
  double value = u[5] * cubic(u[4]);
  scalar::raise(value, u[6], u[7]);
  scalar::sums_of_powers<double> powers;
  powers.add(value, u[0]);
  scalar::sums_of_weights<double> weights;
  weights.add(scalar::line_weight(u[0], u[1], u[2], u[3], u[4]), u[0], u[1]);
  scalar::sums_of_products<double> products;
  products.add(weights.mass, u[0], u[1]);
  scalar::sums_of_six_powers<double> six;
  six.add(scalar::changed_weight(products.cc, u[0], u[1], u[2]), u[3]);
  scalar::sums_of_moments<double> moments;
  moments.add(scalar::entropy_per_mass(value, u[1], u[2]), u[0], u[1]);
  scalar::gaussian_walk<true, double> walk{scalar::gaussian_start(u[0], u[1], u[2]), u[3], u[4]};
  walk.advance();
  scalar::row_contents<double> contents(u[0], 0.0, 0.0);
  contents.add(walk.value);
  scalar::sums_of_squares<double> squares;
  squares.add(u[0], u[1]);
  to[0] = value;
  to[1] = powers.of[3];
  to[2] = products.cc + six.of[5];
  to[3] = moments.energy;
  to[4] = contents.lowest + contents.not_finite;
  to[5] = squares.difference + squares.size;
}

extern "C" void reductions(const double* omega, const double* v, int n, double* to) {
  const scalar::reduced_gas gas{2, 3};
  const auto state = gas.state(omega);
  const auto parts = gas.parts(omega, state, [&](int k) {
    return k == 0 ? scalar::variances_at(v, n, state.u[0]) : scalar::variances_at(v, n, v[1], state.u[1]);
  });
  to[0] = parts.of_g;
  to[1] = parts.others;
  to[2] = scalar::rate_by_viscosity{v[2], v[3]}.of(state.rho, state.T);
}

extern "C" void targets(const double* u, double* to) {
  apsis::line_moments lines;
  lines.set_gaussian(u[0]);
  apsis::target_shape shape;
  shape.variance = u[0];
  for (int k = 0; k < 3; ++k) shape.of_g.w[k] = u[k];
  to[0] = scalar::moments_of_product<3>(lines).correct(shape) ? 1.0 : 0.0;
  const int across[] = {0, 1};
  to[1] = scalar::polynomial_on_line<3, true>(shape.of_g, across, 2, u)(u[3]);
  to[2] = scalar::polynomial_on_line<3, false>(shape.of_h, across, 2, u)(u[3]);
}

extern "C" void stresses(const double* u, double* to) {
  apsis::fluid_state state;
  state.rho = u[0];
  state.T = u[1];
  const scalar::ellipsoidal_model model{u[2]};
  auto target = scalar::ellipsoidal_target<3>::of(model, state, u, u[3], 1.0, 0);
  const int across[] = {0, 1};
  const auto of = scalar::conditional_gaussian<3>::of(u[0], target.covariance, target.inverse, 2, across);
  const auto tables = scalar::correlated_tables::from(of);
  to[0] = tables.fit(u) ? tables.across.row(u[0], u[1]).a : tables.along[0].row(u[0], u[1]).u;
  const auto walk = tables.across.walk({4, u[1]}, u[2], u[3]);
  scalar::walk_over_rows(one_of_eight{3}, walk, u, 6,
                         [to](int row, int j, double value) { to[row + j] += value; });
  to[1] = of.on_line(u, u[4]).a;
  const auto sums = [u](const int* p) { return u[p[0] + p[1] + p[2]]; };
  const scalar::moments_of_base<3, decltype(sums)> moments{sums, {u[0], u[1], u[2]}};
  to[2] = moments.correct(target.shape) ? 1.0 : 0.0;
  const auto stage = apsis::coefficients_of_stage(u[0], u[1], u[2], u[3]);
  to[3] = model.decay(stage) + model.weight_of_derivative(stage);
  const scalar::shakhov_target shakhov{u[5]};
  to[4] = shakhov.decay(stage) + shakhov.weight_of_derivative(stage) +
          shakhov.shape(3, state, u, u[3], 1.0).of_g.w[0];
  scalar::find_heat_flux(3, [u](int k, int l) { return u[k + l]; }, [u](int k) { return u[k]; }, to + 5);
}

extern "C" void mixtures(const double* u, double* to) {
  scalar::image_mixture<double> mixture(u[0], u[1], u[2]);
  mixture.recall(u[3], u[4]);
  mixture.take_off(u[5], u[6]);
  to[0] = mixture.difference();
  to[1] = mixture.mixed;
}

extern "C" void sweeps(const double* u, double* to) {
  scalar::upwind_equation<double> equation(u[0], u[1]);
  equation.add(u[2], u[3], u[4], u[5], u[6], u[7]);
  to[0] = equation.solution();
}

extern "C" void checks_of_row(const double* f, const double* v, int n, double* to) {
  const one_of_eight group{3};
  const auto sums = scalar::moments_of_row<2>(group, f, v, v, n);
  const auto squares = scalar::sum_squares(group, f, v, n);
  to[0] = sums.mass + squares.difference / squares.size;
  to[1] = scalar::entropy_of_row(group, v, f, to, 0.5, n);
}
