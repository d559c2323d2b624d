// Axisymmetric flow without collisions: uniform gas past a body, conservation, positivity, order, and flight
// through the axis.
#include "blocks.hpp"
#include "polar_gas.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/semidiscrete/ring_rotation.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace axisymmetric_test {

namespace {

using namespace polar_gas_test;

/// A ball of radius 0.33 with its centre on the axis at x = 0.52.
double ball(const position& x) {
  return std::hypot(x[0] - 0.52, x[1]) - 0.33;
}

/// Takes steps of the SSP Runge–Kutta method of order 3 (Shu & Osher 1988).
field advanced(const polar_flow& flow, field u, double dt, int steps) {
  const auto add = [&](field& to, double old, double share, const field& from) {
    for (int cell = 0; cell < to.cells(); ++cell)
      for (int k = 0; k < to.components(); ++k) to.row(cell)[k] *= old;
    const apsis::target<field, double> target{&to, share, share * dt, false};
    flow.problem->add_transport(0.0, from, {&target, 1});
  };
  for (int n = 0; n < steps; ++n) {
    const field first = flow.step(u, 1.0, dt);
    field second = u;
    add(second, 0.75, 0.25, first);
    add(u, 1.0 / 3.0, 2.0 / 3.0, second);
  }
  return u;
}

}  // namespace

TEST(axisymmetric, uniform_gas_stays_uniform_past_a_body_and_a_box_on_the_axis) {
  for (const bool limited : {false, true})
    for (const bool box : {false, true}) {
      choices of{.dimensions = 2, .cells = 20, .limited = limited};
      if (box) of.box = {{6, 0, 0}, {5, 4, 1}};
      if (!box) of.body = ball;
      const polar_flow flow = make(of);
      field change = flow.step(flow.at_rest(), 0.0, 1.0);
      for (int cell = 0; cell < change.cells(); ++cell)
        if (flow.mesh().solid(cell) >= 0) std::fill_n(change.row(cell), change.components(), 0.0);
      EXPECT_LT(largest(change), limited ? 1e-11 : 2e-13) << limited << box;
    }
}

TEST(axisymmetric, mass_axial_momentum_and_energy_are_conserved_to_rounding) {
  // The gas is between periodic ends and a wall at r = R with specular reflection.
  apsis::random_source random(5);
  for (int repetition = 0; repetition < 60; ++repetition) {
    choices of{.dimensions = random.integer(1, 3),
               .scheme = random.one_in(2) ? "weno5-z" : "upwind1",
               .limited = random.one_in(2)};
    if (of.scheme == "upwind1") of.limited = false;
    polar_flow flow = make(of);
    const int radial = flow.equation->radial();
    flow.builder->with_boundary(
        {radial, true},
        apsis::make_boundary("diffuse", *flow.equation, {{"T", {1.0}}, {"accommodation", {0.0}}}));
    flow.problem = flow.builder->build();
    const field u = random_state(flow.mesh(), flow.equation->components(), random);
    const auto rates = integrals(flow, flow.step(u, 0.0, 1.0)), sizes = integrals(flow, u);
    // The terms are u times a speed over a width: 1.7 · 10, and 1.3 · 16/(2π 0.05).
    const double rounding = 1e-15 * 100.0 * sizes[0];
    for (const std::size_t k : {0U, 3U, 4U}) EXPECT_NEAR(rates[k], 0.0, rounding) << repetition << " " << k;
    // The budget contains the other invariants too.
    std::vector<double> received(5);
    const auto budget = flow.problem->budget_rates();
    for (std::size_t k = 0; k < budget.size(); ++k) received[k % 5] += budget[k];
    for (std::size_t k = 0; k < 5; ++k)
      EXPECT_NEAR(received[k], rates[k], rounding) << repetition << " " << k;
    EXPECT_GT(std::abs(rates[1]), 1e3 * rounding);
  }
}

TEST(axisymmetric, rotation_gives_the_flux_of_momentum_around_the_axis) {
  // If F has no gradient along r, transport vanishes away from the ends. Only rotation changes F. Then Σ v_r
  // dF/dt = Σ v_θ² F/r up to the fifth order in the angle.
  const polar_flow flow = make({.cells = 16, .angles = 32});
  const polar_gas& gas = *flow.equation;
  field u(flow.mesh().size(), gas.components());
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < gas.components(); ++k)
      u.row(cell)[k] = std::exp(0.3 * gas.v_r(k) + 0.2 * gas.v_theta(k));
  const field change = flow.step(u, 0.0, 1.0);
  constexpr int cell = 8;
  std::array<double, 5> given{};
  gas.invariant_densities(change.row(cell), given.data());
  double hoop = 0.0, shear = 0.0;
  for (int k = 0; k < gas.components(); ++k) {
    const double f = gas.velocities().weights()[at(k)] * u.row(cell)[k] / flow.r(cell);
    hoop += f * gas.v_theta(k) * gas.v_theta(k);
    shear -= f * gas.v_r(k) * gas.v_theta(k);
  }
  EXPECT_NEAR(given[1], hoop, 1e-3 * hoop);
  EXPECT_NEAR(given[2], shear, 1e-3 * hoop);
}

TEST(axisymmetric, steps_within_dt_fe_keep_any_data_nonnegative) {
  check_property("positive", [] {
    apsis::random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const int dimensions = random.integer(1, 3);
    choices of{.dimensions = dimensions,
               .cells = dimensions == 1 ? random.integer(8, 16) : random.integer(6, 11),
               .angles = 4 * random.integer(3, 9),
               .inner = random.one_in(3) ? 0.2 : 0.0,
               .scheme = random.one_in(3)   ? "upwind1"
                         : random.one_in(2) ? "weno5-z"
                                            : "upwind5",
               .outer = random.one_in(2) ? "diffuse" : "outflow",
               .ends = random.one_in(2) ? "diffuse" : "periodic"};
    of.limited = of.scheme != "upwind1";
    if (!of.limited) of.angles -= 8;
    if (dimensions == 2 && of.inner == 0.0 && random.one_in(2)) {
      of.cells = 14;
      of.body = ball;
    }
    const polar_flow flow = make(of);
    field u = random_state(flow.mesh(), flow.equation->components(), random);
    const double share = std::array{1.0, 0.999, 0.3, 1e-2, 1e-5}[at(random.integer(0, 5))];
    flow.problem->limit_for_steps(share);
    const double tau = share * flow.problem->forward_euler_step(0.0, u),
                 alpha = random.integer(1, 100) / 99.0;
    RC_ASSERT(least(flow.step(u, alpha, alpha * tau)) >= 0.0);
  });
}

TEST(axisymmetric, steps_above_dt_fe_make_values_negative) {
  // All mass next to the axis is in the component that limits the step. The scheme is of first order.
  const polar_flow flow = make({.scheme = "upwind1"});
  const polar_gas& gas = *flow.equation;
  field u(flow.mesh().size(), gas.components());
  for (int k = 0; k < gas.components(); ++k)
    if (gas.v_r(k) < 0.0) u.row(0)[k] = 1.0;
  // The angles are isolated. The upstream and downstream neighbours of the angle above π/2 are empty.
  for (int k = 0; k < gas.components(); ++k)
    if (const int angle = k / 4 % 16; angle != 4 && angle != 11) u.row(0)[k] = 0.0;
  const double tau = flow.problem->forward_euler_step(0.0, u);
  EXPECT_GE(least(flow.step(u, 1.0, tau)), 0.0);
  EXPECT_LT(least(flow.step(u, 1.0, 1.0001 * tau)), -1e-6);
}

TEST(axisymmetric, limiter_shortens_no_step) {
  // A velocity towards the axis has the largest rate, |cos ω| + s (M/π) |sin ω_e| in units of v/Δr.
  for (const int angles : {12, 16, 32, 64}) {
    const field u(12, 2 * angles * 4);
    const double free = make({.angles = angles}).problem->forward_euler_step(0.0, u);
    EXPECT_EQ(make({.angles = angles, .limited = true}).problem->forward_euler_step(0.0, u), free) << angles;
    const double width = 2.0 * std::numbers::pi / angles;
    double fastest = 0.0;
    for (int a = angles / 4; a < angles / 2; ++a)
      fastest = std::max(fastest,
                         std::abs(std::cos((a + 0.5) * width)) + std::sin(a * width) / std::sin(0.5 * width));
    EXPECT_NEAR(free * 1.3 / 0.1 * fastest, 1.0, 1e-13);
    EXPECT_NEAR(free * make({.angles = angles}).builder->cfl_rate(), 1.0, 1e-13);
  }
}

TEST(axisymmetric, rotation_has_fifth_order_in_the_angle) {
  // Transport of F = r g(ω) along r is exact away from the ends, so T = v_⊥ sin ω g'(ω).
  const auto error = [](int angles, const std::string& scheme) {
    const polar_flow flow = make({.cells = 16, .angles = angles, .speeds = {1.0}, .scheme = scheme});
    const polar_gas& gas = *flow.equation;
    const auto g = [&](int k) { return std::exp(0.7 * gas.v_r(k) + 0.5 * gas.v_theta(k)); };
    field u(16, gas.components());
    for (int cell = 0; cell < 16; ++cell)
      for (int k = 0; k < gas.components(); ++k) u.row(cell)[k] = flow.r(cell) * g(k);
    const field change = flow.step(u, 0.0, 1.0);
    double most = 0.0;
    for (int k = 0; k < gas.components(); ++k) {
      const double vr = gas.v_r(k), vt = gas.v_theta(k), exact = vt * (0.5 * vr - 0.7 * vt) * g(k);
      most = std::max(most, std::abs(change.row(8)[k] - exact));
    }
    return most;
  };
  EXPECT_NEAR(std::log2(error(64, "upwind5") / error(128, "upwind5")), 5.0, 0.1);
  EXPECT_NEAR(std::log2(error(64, "upwind1") / error(128, "upwind1")), 1.0, 0.1);
  EXPECT_LT(error(32, "upwind5"), 2e-4);
}

TEST(axisymmetric, free_flight_converges_in_radius_and_angle) {
  // The solution is f(t, x, v) = f0(x − v t, v) with f0 = exp(−4|x|² + 0.5 x·v + 0.3 x×v), which is symmetric
  // about the axis. The points are x = (r, 0) with v = (v_r, v_θ).
  const auto solution = [](double t, double r, double vr, double vt) {
    const double x = r - vr * t, y = -vt * t;
    return r * std::exp(-4.0 * (x * x + y * y) + 0.5 * (x * vr + y * vt) + 0.3 * (x * vt - y * vr));
  };
  const auto error = [&](int cells, int angles) {
    const polar_flow flow = make({.cells = cells,
                                  .angles = angles,
                                  .speeds = {1.0},
                                  .along = {-1.0, 1.0},
                                  .length = 3.0,
                                  .outer = "vacuum"});
    const polar_gas& gas = *flow.equation;
    field u(cells, gas.components());
    const auto fill = [&](field& to, double t) {
      for (int cell = 0; cell < cells; ++cell)
        for (int k = 0; k < gas.components(); ++k)
          to.row(cell)[k] = solution(t, flow.r(cell), gas.v_r(k), gas.v_theta(k));
    };
    constexpr double end = 0.4;
    fill(u, 0.0);
    const double dt = 0.5 * flow.problem->forward_euler_step(0.0, u);
    const int steps = static_cast<int>(std::ceil(end / dt));
    u = advanced(flow, std::move(u), end / steps, steps);
    field expected(cells, gas.components());
    fill(expected, end);
    double sum = 0.0;
    for (int cell = 0; cell < cells; ++cell)
      for (int k = 0; k < gas.components(); ++k)
        sum += std::abs(u.row(cell)[k] - expected.row(cell)[k]) / (cells * gas.components());
    return sum;
  };
  // Images at the axis conserve mass with second order in Δr. Elsewhere the schemes are of fifth order.
  const double coarse = error(20, 16), middle = error(40, 32), fine = error(80, 64);
  EXPECT_LT(fine, 2e-5);
  EXPECT_GT(std::log2(coarse / middle), 1.9);
  EXPECT_GT(std::log2(middle / fine), 1.9);
}

TEST(axisymmetric, disturbances_decay_between_the_axis_and_a_diffuse_wall) {
  // Random disturbances of a half decay over more than a hundred transits of the slow ring, at the smallest
  // number of angles. Growing waves would exceed the tolerance.
  for (const double cfl : {0.5, 1.0}) {
    const polar_flow flow = make({.cells = 10, .angles = 12, .speeds = {0.5, 1.0}, .along = {1.0}});
    apsis::random_source random(3);
    const field at_rest = flow.at_rest();
    field u = at_rest;
    for (int cell = 0; cell < u.cells(); ++cell)
      for (int k = 0; k < u.components(); ++k) u.row(cell)[k] *= random.uniform(0.5, 1.5);
    const double dt = cfl * flow.problem->forward_euler_step(0.0, u);
    u = advanced(flow, std::move(u), dt, static_cast<int>(300.0 / dt));
    const double mass = integrals(flow, u)[0] / integrals(flow, at_rest)[0];
    for (int cell = 0; cell < u.cells(); ++cell)
      for (int k = 0; k < u.components(); ++k)
        EXPECT_NEAR(u.row(cell)[k], mass * at_rest.row(cell)[k], 1e-3 * at_rest.row(cell)[k]);
  }
}

TEST(axisymmetric, a_ring_of_molecules_crosses_the_axis) {
  const polar_flow flow =
      make({.cells = 40, .angles = 32, .speeds = {1.0}, .along = {-1.0, 1.0}, .length = 2.0});
  const polar_gas& gas = *flow.equation;
  // Initially molecules at r = 0.5 move towards the axis, v_r < 0, within some angles of −r.
  field u(flow.mesh().size(), gas.components());
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < gas.components(); ++k) {
      const double r = flow.r(cell), angle = std::atan2(gas.v_theta(k), -gas.v_r(k));
      u.row(cell)[k] = r * std::exp(-50.0 * (r - 0.5) * (r - 0.5) - 4.0 * angle * angle);
    }
  const auto before = integrals(flow, u);
  const double dt = 0.5 * flow.problem->forward_euler_step(0.0, u), end = 1.2;
  const int steps = static_cast<int>(std::ceil(end / dt));
  u = advanced(flow, std::move(u), end / steps, steps);
  const auto after = integrals(flow, u);
  EXPECT_NEAR(after[0], before[0], 1e-13 * before[0] * steps);
  EXPECT_NEAR(after[4], before[4], 1e-13 * before[4] * steps);
  // At the end all molecules move away from the axis. They are at a distance of 0.7 or more on
  // its other side.
  double inwards = 0.0, near = 0.0, sum = 0.0;
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < gas.components(); ++k) {
      const double mass = u.row(cell)[k];
      sum += mass;
      if (gas.v_r(k) < 0.0) inwards += std::abs(mass);
      if (flow.r(cell) < 0.3) near += std::abs(mass);
    }
  EXPECT_LT(inwards, 0.02 * sum);
  EXPECT_LT(near, 0.02 * sum);
}

TEST(axisymmetric, rows_that_are_even_in_the_azimuthal_velocity_stay_even_to_the_last_bit) {
  apsis::random_source random(7);
  const polar_flow flow = make({.limited = true});
  const polar_gas& gas = *flow.equation;
  field u = random_state(flow.mesh(), gas.components(), random);
  const auto image = [](int k) { return k / 64 * 64 + (15 - k / 4 % 16) * 4 + k % 4; };
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < gas.components(); ++k)
      if (gas.v_theta(k) < 0.0) u.row(cell)[k] = u.row(cell)[image(k)];
  const field next = flow.step(u, 1.0, flow.problem->forward_euler_step(0.0, u));
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < gas.components(); ++k) ASSERT_EQ(next.row(cell)[k], next.row(cell)[image(k)]) << cell;
}

TEST(axisymmetric, epsilon_and_sources_are_those_of_f) {
  // With the rate ρ, Q(F) = r² Q(f). Collisions thus change r f by r times the change of f.
  for (const bool by_density : {false, true}) {
    polar_flow flow = make({.by_density = by_density});
    flow.builder->with_epsilon([](const position& x) { return 0.5 + x[0]; })
        .with_source({[](double, const position& x, std::span<const double> u, std::span<double> row) {
                        for (std::size_t k = 0; k < row.size(); ++k) row[k] = u[k] * (1.0 + x[0]);
                      },
                      false, [](double, const position& x, std::span<const double>) { return 1.0 + x[0]; }});
    const auto f = [&](const position& x, std::span<double> row) {
      for (std::size_t k = 0; k < row.size(); ++k) row[k] = 1.0 + x[0] + 0.01 * static_cast<double>(k);
    };
    const field u = flow.builder->sample(f);
    const field without = flow.step(u, 0.0, 1.0);
    flow.problem = flow.builder->build();
    const field with = flow.step(u, 0.0, 1.0);
    field q(u.cells(), u.components());
    const apsis::target<field, double> to{&q, 0.0, 1.0, true};
    flow.problem->add_collision(0.0, u, {&to, 1});
    const polar_gas& gas = *flow.equation;
    std::vector<double> row(at(gas.components())), e(row.size());
    for (int cell = 0; cell < u.cells(); ++cell) {
      const double r = flow.r(cell);
      f({r}, row);
      double rho = 0.0;
      gas.moments(row.data(), &rho);
      gas.equilibrium(&rho, e.data());
      for (int k = 0; k < gas.components(); ++k) {
        const double expected = gas.rate(&rho) * (e[at(k)] - row[at(k)]) / (0.5 + r);
        EXPECT_NEAR(q.row(cell)[k], r * expected, 1e-12 * std::abs(rho));
        EXPECT_NEAR(with.row(cell)[k] - without.row(cell)[k], r * row[at(k)] * (1.0 + r), 1e-12);
      }
    }
    EXPECT_DOUBLE_EQ(flow.problem->growth_of_source(0.0, u), 1.0 + flow.r(u.cells() - 1));
  }
}

TEST(axisymmetric, blocks_have_the_bits_of_one_process) {
  apsis::random_source random(3);
  for (int repetition = 0; repetition < 6; ++repetition) {
    choices of{.dimensions = 2, .cells = 14, .limited = random.one_in(2), .ends = "diffuse"};
    if (random.one_in(2)) of.body = ball;
    const polar_flow whole = make(of);
    const field u = random_state(whole.mesh(), whole.equation->components(), random);
    const std::array<int, 3> blocks = {random.integer(1, 4), random.integer(1, 4), 1};
    ASSERT_NO_THROW(check_blocks(
        whole, u, blocks,
        [&](const std::shared_ptr<apsis::communicator>& processes) { return make(of, processes, blocks); }))
        << repetition;
  }
}

TEST(axisymmetric, flows_that_are_not_possible_are_refused) {
  const auto changed = [](const std::function<void(polar_flow&)>& change) {
    polar_flow flow = make({.dimensions = 2});
    change(flow);
    flow.builder->build();
  };
  EXPECT_NO_THROW(changed([](polar_flow&) {}));
  bad_input::expect_refused({
      {[&] { changed([](polar_flow& flow) { flow.builder->with_axis(0); }); },
       {"axisymmetric flow in 2 dimensions with r in direction 1"}},
      {[&] {
         changed([](polar_flow& flow) {
           flow.builder->with_boundary({1, false}, apsis::make_boundary("outflow"));
         });
       },
       {"the lower end r = 0 is not an axis"}},
      {[&] {
         changed([](polar_flow& flow) {
           flow.builder->with_boundary({1, true}, apsis::make_boundary("symmetry"));
         });
       },
       {"a boundary with mirror images at r = const (a cylinder is no plane of symmetry)"}},
      {[&] {
         changed([](polar_flow& flow) {
           flow.builder->with_boundary({1, true}, apsis::make_boundary("periodic"));
         });
       },
       {"the flow is periodic in r"}},
      {[&] {
         changed(
             [](polar_flow& flow) { flow.builder->with_boundary({1, true}, side("axis", *flow.equation)); });
       },
       {"boundary 'axis' at the upper end"}},
  });
  bad_input::expect_refused({
      {[] { make({.inner = -0.1}); }, {"the mesh begins at r = -0.1"}},
      {[] { make({.angles = 8}); }, {"8 angles of velocities"}},
      {[] { make({.angles = 6}); }, {"the velocities are not symmetric"}},
      {[] {
         polar_flow flow = make({});
         flow.builder->with_discretization("finite-volume").build();
       },
       {"axisymmetric flow with cell averages (the radius varies in a cell)"}},
      {[] {
         const polar_gas gas(1, {1.0}, 12, {-1.0, 1.0});
         apsis::problem_builder(gas)
             .on(grid::line(8, 0.0, 1.0))
             .with_discretization("finite-difference")
             .with_reconstruction(apsis::find_reconstruction("upwind5").make())
             .with_boundary({0, false}, side("axis", gas))
             .with_boundary({0, true}, side("outflow", gas))
             .build();
       },
       {"the boundary 'axis' in a flow that is not axisymmetric"}},
  });
}

}  // namespace axisymmetric_test
