// Transport past bodies: a gas at rest, conservation, positivity, images, threads, and refusals.
#include <apsis/semidiscrete/cut_transport.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semidiscrete/gas_past_bodies.hpp>
#include <support/bad_input.hpp>

namespace cut_transport_test {
using namespace gas_past_bodies_test;

TEST(cut_transport, leaves_a_gas_at_rest_alone) {
  for (const choices& one : some_flows()) {
    const gas_past_bodies gas = make(one);
    ASSERT_GT(gas.mesh().cut()->groups().size(), 10U);
    const field u = gas.uniform();
    // The unit is the flux through the faces of a cell.
    EXPECT_LT(largest(gas.step(u, 0.0, 1.0)) * gas.mesh().spacing(0) / 4.0, 1e-14)
        << one.scheme << one.boundary;
    // The rate at each wall must be finite.
    const auto rates = gas.problem->budget_rates();
    for (const double rate : rates) EXPECT_TRUE(std::isfinite(rate));
  }
}

TEST(cut_transport, gives_bodies_in_a_gas_at_rest_no_force) {
  for (const std::string wall : {"diffuse", "symmetry"}) {
    const gas_past_bodies gas = make({.cells = 20, .bodies = {ball({0.12, -0.12, 0}, 0.47)}, .wall = wall});
    gas.step(gas.uniform(), 0.0, 1.0);
    const auto rates = gas.problem->budget_rates();
    const std::size_t count = gas.equation->invariants().size();
    const auto& space = gas.builder->space();
    std::vector<double> force(count), sizes(count);
    std::size_t end = 0;
    for (const auto& surface : space.budget_surfaces()) {
      const std::size_t ends = space.ends_at(surface);
      for (std::size_t k = end * count; k < (end + ends) * count && surface.solid >= 0; ++k) {
        force[k % count] += rates[k];
        sizes[k % count] += std::abs(rates[k]);
      }
      end += ends;
    }
    // On both sides of a length of about 1 the pressure is 1, up to the rounding of sums.
    for (std::size_t k = 1; k + 1 < count; ++k) {
      EXPECT_GT(sizes[k], 1.0) << wall << k;
      EXPECT_LE(std::abs(force[k]), 1e-13 * sizes[k]) << wall << k;
    }
  }
}

TEST(cut_transport, conserves_what_walls_do_not_give) {
  std::mt19937 generator(1);
  int reflecting = 0, without_heat = 0;
  for (const choices& one : some_flows()) {
    const gas_past_bodies gas = make(one);
    const field u = random_state(gas.mesh(), gas.equation->components(), generator);
    const auto change = integrals(gas, gas.step(u, 0.0, 1.0));
    const auto rates = gas.problem->budget_rates();
    const std::size_t count = change.size();
    std::vector<double> given(count), sizes(count);
    for (std::size_t k = 0; k < rates.size(); ++k) {
      given[k % count] += rates[k];
      sizes[k % count] += std::abs(rates[k]);
    }
    // The tolerance is relative to the amounts that cross the border, sums of some thousand terms.
    for (std::size_t k = 0; k < count; ++k)
      EXPECT_NEAR(change[k], given[k], 1e-12 * (1.0 + sizes[k])) << one.scheme << " " << one.boundary << k;
    // No mass passes a wall, up to the rounding of fluxes of size 10.
    const auto& space = gas.builder->space();
    std::size_t end = 0;
    for (const auto& surface : space.budget_surfaces()) {
      const std::size_t ends = space.ends_at(surface);
      for (std::size_t k = end; k < end + ends && surface.solid >= 0; ++k)
        EXPECT_NEAR(rates[k * count], 0.0, 1e-14) << one.scheme << one.boundary << one.wall;
      for (std::size_t k = end; k < end + ends && surface.solid >= 0 && one.wall == "symmetry"; ++k) {
        ++reflecting;
        if (std::abs(rates[k * count + count - 1]) <= 1e-13) ++without_heat;
      }
      end += ends;
    }
  }
  // No energy passes a reflecting wall if several values of a state have similar size. The states have
  // values over ten decades and zeros. A single value may thus have nearly all of the mass (14 of 3080 walls
  // for ten seeds).
  EXPECT_GE(without_heat, 0.98 * reflecting);
  EXPECT_GT(reflecting, 100);
}

TEST(cut_transport, passes_no_mass_through_planes_of_symmetry_beside_bodies) {
  std::mt19937 generator(5);
  int ends_seen = 0;
  // One to four cells lie between the body and the planes.
  for (const double radius : {0.47, 0.57, 0.67, 0.77})
    for (const std::string scheme : {"weno5-z", "upwind5"})
      for (const bool limited : {true, false}) {
        const gas_past_bodies gas = make({.cells = 20,
                                          .bodies = {ball({0.12, -0.12, 0}, radius)},
                                          .scheme = scheme,
                                          .boundary = "symmetry",
                                          .limited = limited});
        gas.step(random_state(gas.mesh(), gas.equation->components(), generator), 0.0, 1.0);
        const auto rates = gas.problem->budget_rates();
        const std::size_t count = gas.equation->invariants().size();
        const auto& space = gas.builder->space();
        std::size_t end = 0;
        for (const auto& surface : space.budget_surfaces()) {
          const std::size_t ends = space.ends_at(surface);
          for (std::size_t k = end; k < end + ends && surface.solid < 0; ++k) {
            // The rates are sums of 100 products of speeds up to 4 and values up to 10, in which
            // the images cancel.
            EXPECT_NEAR(rates[k * count], 0.0, 1e-12) << radius << scheme << limited;
            EXPECT_NEAR(rates[k * count + count - 1], 0.0, 1e-11) << radius << scheme << limited;
            ++ends_seen;
          }
          end += ends;
        }
      }
  EXPECT_EQ(ends_seen, 16 * 80);
}

TEST(cut_transport, keeps_random_states_nonnegative_in_steps_within_the_bound) {
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> place(-1.0, 1.0), size(0.25, 0.6);
  int runs = 0, broken = 0;
  for (int k = 0; k < 40; ++k) {
    choices one{.cells = 16 + k % 4,
                .bodies = {ball({place(generator), place(generator), 0}, size(generator)),
                           ball({place(generator), place(generator), 0}, size(generator))},
                .scheme = k % 2 == 0 ? "weno5-z" : "upwind5",
                .boundary = k % 3 == 0 ? "diffuse" : "outflow",
                .wall = k % 5 == 1 ? "symmetry" : "diffuse",
                .accommodation = k % 5 == 2 ? 0.5 : 1.0};
    if (k % 8 == 7) {
      one.dimensions = 3;
      one.cells = 10;
      one.bodies = {ball({0.4 * place(generator), 0.4 * place(generator), 0.4 * place(generator)}, 0.6)};
    }
    try {
      const gas_past_bodies gas = make(one);
      field u = random_state(gas.mesh(), gas.equation->components(), generator);
      const double dt = gas.problem->forward_euler_step(0.0, u);
      for (int step = 0; step < 4; ++step) {
        const field longer = gas.step(u, 1.0, 1.5 * dt);
        broken += least_value(longer) < 0.0 ? 1 : 0;
        u = gas.step(u, 1.0, dt);
        ASSERT_GE(least_value(u), 0.0) << k << " " << step;
      }
      ++runs;
    } catch (const apsis::input_error& error) {
      EXPECT_THAT(error.what(), testing::AnyOf(testing::HasSubstr("thinner than a cell"),
                                               testing::HasSubstr("has no wall in the domain")));
    }
  }
  EXPECT_GT(runs, 20);
  EXPECT_GT(broken, 20);
}

TEST(cut_transport, gives_the_cells_of_a_group_the_same_values) {
  std::mt19937 generator(3);
  const gas_past_bodies gas = make(some_flows().front());
  const field u = gas.step(random_state(gas.mesh(), gas.equation->components(), generator), 1.0, 0.01);
  int joined = 0;
  for (const auto& group : gas.mesh().cut()->groups())
    for (const int cell : group.cells) {
      joined += cell > group.cells.front() ? 1 : 0;
      for (int k = 0; k < u.components(); ++k) EXPECT_EQ(u.row(cell)[k], u.row(group.cells.front())[k]);
    }
  EXPECT_GT(joined, 5);
}

TEST(cut_transport, commutes_with_rotations_by_right_angles) {
  // The body, the state and the velocities are mapped by x → y, y → −x.
  for (const std::string wall : {"diffuse", "symmetry"}) {
    const auto with = [&](position centre) {
      return make({.cells = 18, .bodies = {ball(centre, 0.47)}, .boundary = "outflow", .wall = wall});
    };
    const gas_past_bodies gas = with({0.21, 0.13, 0}), turned = with({-0.13, 0.21, 0});
    const int n = 18, points = 10;
    field u = gas.uniform(), v = turned.uniform();
    const auto image_of = [&](int cell) { return (n - 1 - cell % n) * n + cell / n; };
    const auto velocity_of = [&](int k) {
      const int set = k / (points * points), i = k / points % points, j = k % points;
      return set * points * points + (points - 1 - j) * points + i;
    };
    for (int cell = 0; cell < u.cells(); ++cell)
      for (int k = 0; k < u.components(); ++k) {
        const position x = gas.mesh().centre(cell);
        if (gas.mesh().solid(cell) < 0) u.row(cell)[k] *= 1.5 + std::sin(3.0 * x[0] + x[1] + 0.1 * k);
        v.row(image_of(cell))[velocity_of(k)] = u.row(cell)[k];
      }
    const field a = gas.step(u, 0.0, 1.0), b = turned.step(v, 0.0, 1.0);
    double difference = 0.0;
    for (int cell = 0; cell < u.cells(); ++cell)
      for (int k = 0; k < u.components(); ++k)
        difference = std::max(difference, std::abs(a.row(cell)[k] - b.row(image_of(cell))[velocity_of(k)]));
    // Sums in another order differ by 3e-15.
    EXPECT_LT(difference, 1e-13 * largest(a)) << wall;
  }
}

TEST(cut_transport, does_not_depend_on_the_number_of_threads) {
  std::mt19937 generator(4);
  const gas_past_bodies gas = make(some_flows().front());
  const field u = random_state(gas.mesh(), gas.equation->components(), generator);
  const field one = gas.step(u, 1.0, 0.01);
  apsis::set_threads(3);
  const field three = gas.step(u, 1.0, 0.01);
  apsis::set_threads(1);
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < u.components(); ++k) ASSERT_EQ(one.row(cell)[k], three.row(cell)[k]);
}

TEST(cut_transport, of_a_box_on_edges_is_that_of_a_solid_box) {
  const outside_function box = [](const position& x) {
    return std::max(std::abs(x[0]), std::abs(x[1])) - 0.5;
  };
  for (const double accommodation : {1.0, 0.5, 0.0}) {
    const gas_past_bodies body = make({.cells = 16, .bodies = {box}, .accommodation = accommodation});
    apsis::problem_builder builder(*body.equation);
    builder.on(grid(2, {16, 16, 1}, {-1, -1, -1}, {1, 1, 1}).with_solids({{{4, 4, 0}, {8, 8, 1}}}))
        .with_discretization("finite-difference")
        .with_reconstruction(apsis::find_reconstruction("weno5-z").make())
        .with_positivity_limiter()
        .with_epsilon([](const position&) { return 1.0; })
        .with_solid(0, apsis::make_boundary("diffuse", *body.equation, {{"accommodation", {accommodation}}}));
    const auto solid = builder.build();
    std::mt19937 generator(5);
    const field u = random_state(body.mesh(), body.equation->components(), generator);
    const field a = body.step(u, 0.0, 1.0);
    field b(u.cells(), u.components());
    const apsis::target<field, double> to{&b, 0.0, 1.0, true};
    // The limiter must be the same. It depends on the step, which is half as long on a mesh with bodies.
    solid->limit_for_steps(0.5);
    solid->add_transport(0.0, u, {&to, 1});
    for (int cell = 0; cell < u.cells(); ++cell)
      for (int k = 0; k < u.components(); ++k) ASSERT_EQ(a.row(cell)[k], b.row(cell)[k]) << cell;
  }
}

TEST(cut_transport, refuses_boundaries_and_walls_that_a_body_cannot_have) {
  const auto with = [](const std::string& kind, const apsis::face_quantities& values) {
    return [=] {
      gas_past_bodies gas = make({.bodies = {ball({0.1, 0, 0}, 0.5)}});
      gas.builder->with_solid(
          0, values.empty() ? apsis::make_boundary(kind) : apsis::make_boundary(kind, *gas.equation, values));
      gas.builder->build();
    };
  };
  bad_input::expect_refused({
      {with("outflow", {}), {"that serves faces of cells alone"}},
      {with("diffuse", {{"accommodation", {1.5}}}),
       {"the accommodation of a diffuse wall is 1.5 at t = 0 ("}},
  });
  bad_input::expect_refused({
      {[] {
         const gas_past_bodies gas =
             make({.bodies = {ball({0.1, 0, 0}, 0.5)},
                   .accommodation = apsis::face_quantity([](double, const position& at) { return at[0]; })});
         gas.step(gas.uniform(), 1.0, 0.1);
       },
       {"(a number from 0 to 1"}},
  });
  EXPECT_THAT(
      [] {
        const gas_past_bodies gas = make({.bodies = {ball({0.1, 0, 0}, 0.5)}, .wall_velocity = {1.0, 0.0}});
        gas.step(gas.uniform(), 1.0, 0.1);
      },
      testing::ThrowsMessage<apsis::input_error>(testing::ContainsRegex(
          "is -?[0-9.]+ along its normal at t = 0 near \\(-?0\\.[0-9]+, -?[0-9.e-]+\\) \\(the body")));
}

}  // namespace cut_transport_test
