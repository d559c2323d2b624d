#include "bgk_case.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/scheme/quartic.hpp>

#include <limits>

#include <support/property.hpp>

namespace collision_test {

namespace {

using apsis::field;
using apsis::grid;
using limits = apsis::limited_reconstruction::limits;

double epsilon_of(double x) {
  return 1e-5 + std::tanh(1 - 11 * (x - 1)) + std::tanh(1 + 11 * (x - 1));
}

std::vector<double> at_gauss_points(const grid& mesh, double (*f)(double)) {
  std::vector<double> values;
  for (int i = 0; i < mesh.size(); ++i)
    for (const double xi : apsis::gauss3::xi) values.push_back(f(mesh.centre(i, 0) + xi * mesh.spacing(0)));
  return values;
}

std::vector<double> at_centres(const grid& mesh, double (*f)(double)) {
  std::vector<double> values;
  for (int i = 0; i < mesh.size(); ++i) values.push_back(f(mesh.centre(i, 0)));
  return values;
}

/// Returns smooth data off equilibrium.
field smooth(const apsis::relaxation_model& m, const grid& mesh, bool averages) {
  std::vector<double> row(static_cast<std::size_t>(m.components()));
  return sample(mesh, m.components(), averages, [&](double x, int k) {
    if (k == 0) m.initial()[2].point_value({x}, row);
    m.initial()[2].point_value({x}, row);
    return row[static_cast<std::size_t>(k)];
  });
}

}  // namespace

TEST(collision, conserves_to_rounding_although_epsilon_varies_inside_cells) {
  const auto m = small_bgk();
  const grid mesh = grid::line(20, 0.0, 2.0);
  for (const bool averages : {true, false}) {
    const auto q =
        averages ? apsis::make_cell_average_collision(*m, space_of(mesh), scheme("weno5-z", limits::edges),
                                                      at_gauss_points(mesh, epsilon_of))
                 : apsis::make_pointwise_collision(*m, at_centres(mesh, epsilon_of));
    field u = smooth(*m, mesh, averages);
    const field before = u;
    q->solve(0.0, 1e-2, -1e-4, u);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(total(*m, u, k), total(*m, before, k), 2e-14 * 20) << averages << " moment " << k;
  }
}

TEST(collision, averages_are_fifth_order_against_the_exact_average_of_relaxed_point_values) {
  const auto m = small_bgk();
  const double a = 0.3;
  const auto error = [&](int n) {
    const grid mesh = grid::line(n, 0.0, 2.0);
    const auto smooth_epsilon = [](double x) { return 1.2 + std::sin(std::numbers::pi * x); };
    const auto q = apsis::make_cell_average_collision(*m, space_of(mesh), scheme("weno5-z", limits::edges),
                                                      at_gauss_points(mesh, +smooth_epsilon));
    field u = smooth(*m, mesh, true);
    q->solve(0.0, a, 0.0, u);
    std::vector<double> row(static_cast<std::size_t>(m->components())), e = row, omega(3);
    const field exact = sample(mesh, m->components(), true, [&](double x, int k) {
      m->initial()[2].point_value({x}, row);
      m->moments(row.data(), omega.data());
      m->equilibrium(omega.data(), e.data());
      const double mu = a / smooth_epsilon(x);
      const auto component = static_cast<std::size_t>(k);
      return (row[component] + mu * e[component]) / (1.0 + mu);
    });
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < m->components(); ++k) sum += std::abs(u.row(i)[k] - exact.row(i)[k]);
    return sum / n;
  };
  EXPECT_GT(std::log2(error(32) / error(64)), 4.8);
}

TEST(collision, limit_of_vanishing_epsilon_is_the_equilibrium_and_zero_is_allowed) {
  const auto m = small_bgk();
  const grid mesh = grid::line(8, 0.0, 2.0);
  const auto zero = [](double) { return 0.0; };
  const auto tiny = [](double) { return 1e-200; };  // (Δt/ε)² overflows
  const auto q0 = apsis::make_pointwise_collision(*m, at_centres(mesh, zero));
  const auto q1 = apsis::make_pointwise_collision(*m, at_centres(mesh, tiny));
  field u0 = smooth(*m, mesh, false), u1 = u0;
  std::vector<double> e(static_cast<std::size_t>(m->components())), omega(3);
  m->moments(u0.row(3), omega.data());
  m->equilibrium(omega.data(), e.data());
  q0->solve(0.0, 0.1, -0.3, u0);
  q1->solve(0.0, 0.0, -0.3, u1);
  for (int k = 0; k < m->components(); ++k) {
    EXPECT_EQ(u0.row(3)[k], e[static_cast<std::size_t>(k)]);
    EXPECT_EQ(u1.row(3)[k], e[static_cast<std::size_t>(k)]);
  }
}

TEST(collision, keeps_limited_data_nonnegative) {
  const auto m = small_bgk();
  const grid mesh = grid::line(12, 0.0, 2.0);
  check_property("nonnegative", [&] {
    static double epsilon = 1.0;
    epsilon = *rc::gen::inRange(0, 4) == 0 ? 0.0 : std::pow(10.0, *rc::gen::inRange(-12, 13));
    const auto q = apsis::make_cell_average_collision(*m, space_of(mesh), scheme("weno5-z", limits::edges),
                                                      at_gauss_points(mesh, [](double) { return epsilon; }));
    field u(12, m->components());
    for (int i = 0; i < 12; ++i)
      for (int k = 0; k < m->components(); ++k)
        u.row(i)[k] = *rc::gen::element(0.0, 1.0, 0.2) * std::pow(10.0, *rc::gen::element(0, -2, -8)) +
                      1e-3 * (k == 20);
    q->solve(0.0, *rc::gen::element(0.0, 1e-3, 1.0), -*rc::gen::element(0.0, 1e-6, 1.0), u);
    for (int i = 0; i < 12; ++i)
      for (int k = 0; k < m->components(); ++k) RC_ASSERT(u.row(i)[k] >= 0.0);
  });
}

TEST(collision, a_state_without_a_temperature_fails_with_its_cell) {
  const auto m = small_bgk();
  const grid mesh = grid::line(8, 0.0, 2.0);
  const auto q = apsis::make_pointwise_collision(*m, std::vector<double>(8, 1.0));
  field u = smooth(*m, mesh, false);
  for (int k = 0; k < m->components(); ++k) u.row(5)[k] = k == 0 || k == 39 ? -0.4 : 0.05;
  try {
    q->solve(0.0, 1.0, 0.0, u);
    FAIL() << "no error";
  } catch (const apsis::numerical_error& failure) {
    EXPECT_EQ(failure.site().cell, 5);
    EXPECT_NE(failure.problem().find("is not positive"), std::string::npos) << failure.what();
  }
}

TEST(collision, advises_the_limiter_only_where_it_is_off) {
  const auto m = small_bgk();
  const grid mesh = grid::line(8, 0.0, 2.0);
  field u = smooth(*m, mesh, false);
  for (int cell = 0; cell < 8; ++cell)
    for (int k = 0; k < m->components(); ++k) u.row(cell)[k] *= -1.0;
  const auto said = [&](apsis::collision& q) -> std::string {
    field v = u;
    try {
      q.solve(0.0, 1.0, 0.0, v);
    } catch (const apsis::numerical_error& failure) {
      return failure.problem();
    }
    return "nothing";
  };
  const std::string off = "is not positive); use the positivity limiter or a smaller step";
  const std::string on = "is not positive); use steps within r dt_FE";
  const std::vector<double> ones(24, 1.0);
  EXPECT_NE(said(*apsis::make_pointwise_collision(*m, ones)).find(off), std::string::npos);
  EXPECT_NE(said(*apsis::make_pointwise_collision(*m, ones, true)).find(on), std::string::npos);
  for (const auto kind : {limits::nothing, limits::edges}) {
    const auto q = apsis::make_cell_average_collision(*m, space_of(mesh), scheme("weno5-z", kind), ones);
    EXPECT_NE(said(*q).find(kind == limits::nothing ? off : on), std::string::npos) << said(*q);
  }
}

TEST(collision, explicit_evaluation_agrees_with_the_implicit_one_for_small_steps) {
  const auto m = small_bgk();
  const grid mesh = grid::line(10, 0.0, 2.0);
  for (const bool averages : {true, false}) {
    const auto q =
        averages ? apsis::make_cell_average_collision(*m, space_of(mesh), scheme("weno5-z", limits::nothing),
                                                      std::vector<double>(30, 0.5))
                 : apsis::make_pointwise_collision(*m, std::vector<double>(10, 0.5));
    const field u = smooth(*m, mesh, averages);
    field implicit = u, change(10, m->components());
    const double dt = 1e-7;
    q->solve(0.0, dt, 0.0, implicit);
    const apsis::target<field, double> to{&change, 0.0, 1.0, true};
    q->add_collision(0.0, u, {&to, 1});
    for (int i = 0; i < 10; ++i)
      for (int k = 0; k < m->components();
           ++k)  // first order in dt, plus the rounding error of u divided by dt
        EXPECT_NEAR((implicit.row(i)[k] - u.row(i)[k]) / dt, change.row(i)[k], 2e-6);
  }
}

}  // namespace collision_test
