// The upwind sweep inverts its operator.
#include <apsis/steady/octant_sweep.hpp>

#include "gas_problem.hpp"

#include <apsis/exec/parallel.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace octant_sweep_test {
namespace {

using apsis::field;

constexpr double slope = 0.4;

/// Returns the value at the downstream edge of a cell, δ + slope (δ − upstream), or δ alone where
/// the gas begins.
double edge(const apsis::cell_links& links, const field& d, int direction, bool up, int cell, int k) {
  const int before = links.next(direction, !up, cell);
  return before < 0 ? d.row(cell)[k] : d.row(cell)[k] + slope * (d.row(cell)[k] - d.row(before)[k]);
}

/// Returns (L + σ) δ for nothing that enters.
field apply(const apsis::model& equation, const apsis::grid& mesh, const apsis::cell_links& links,
            const std::vector<double>& rates, const field& d) {
  field sum(d.cells(), d.components());
  for (const int cell : links.cells())
    for (int k = 0; k < d.components(); ++k) {
      double& to = sum.row(cell)[k];
      to = rates[static_cast<std::size_t>(cell)] * d.row(cell)[k];
      for (int direction = 0; direction < mesh.dimensions(); ++direction) {
        const double v = equation.speeds(direction)[static_cast<std::size_t>(k)];
        const bool up = v > 0.0;
        const int before = links.next(direction, !up, cell);
        const double entering = before < 0 ? 0.0 : edge(links, d, direction, up, before, k);
        to += std::abs(v) / mesh.spacing(direction) * (edge(links, d, direction, up, cell, k) - entering);
      }
    }
  return sum;
}

/// Surrounds a gas by a vacuum.
void with_vacuum(const gas_problem& gas, int dimensions) {
  for (int d = 0; d < dimensions; ++d)
    for (const bool upper : {false, true})
      gas.space->with_boundary({d, upper}, apsis::make_boundary("vacuum", *gas.equation, {}));
}

/// A right side and rates of collisions, drawn for a property.
struct drawn_step {
  field r;
  std::vector<double> rates;

  drawn_step(int cells, int components) : r(cells, components) {
    for (int cell = 0; cell < cells; ++cell) {
      rates.push_back(*rc::gen::element(1e-9, 1.0, 1e3));
      for (int k = 0; k < components; ++k) r.row(cell)[k] = *rc::gen::inRange(-1000, 1001) / 1000.0;
    }
  }
};

/// Checks that threads do not change the solution d. They share the components of an octant, and there may be
/// more threads than components.
void expect_equal_bits_on_threads(apsis::octant_sweep& sweep, const field& f, const drawn_step& step,
                                  const field& d) {
  for (const int threads : {2, 3, 7, 64}) {
    apsis::set_threads(threads);
    field same = step.r;
    sweep.solve(f, step.rates, same);
    apsis::set_threads(1);
    for (int cell = 0; cell < d.cells(); ++cell)
      RC_ASSERT(std::equal(d.row(cell), d.row(cell) + d.components(), same.row(cell)));
  }
}

class sweeps : public testing::TestWithParam<int> {};

}  // namespace

TEST_P(sweeps, solve_the_implicit_step_exactly) {
  const int dimensions = GetParam();
  const auto equation = make_gas("bgk", dimensions, {4.0, 6}, dimensions);
  gas_problem gas = gas_between_walls(equation, dimensions, 5, 1.0);
  // Beyond the ends there is a vacuum, so nothing enters.
  with_vacuum(gas, dimensions);
  const apsis::domain& space = gas.space->space();
  const apsis::cell_links links(space);
  const apsis::cut_links cut(space);
  apsis::octant_sweep sweep(*equation, space, links, cut, slope);
  check_property("rounding", [&] {
    const drawn_step step(space.mesh().size(), equation->components());
    const auto& [r, rates] = step;
    field d = r;
    sweep.solve(gas.at_rest(), rates, d);
    const field back = apply(*equation, space.mesh(), links, rates, d);
    for (int cell = 0; cell < r.cells(); ++cell)
      for (int k = 0; k < r.components(); ++k)
        RC_ASSERT(std::abs(back.row(cell)[k] - r.row(cell)[k]) < 1e-12);  // sums of some ten terms ≤ 1
    expect_equal_bits_on_threads(sweep, gas.at_rest(), step, d);
  });
}

TEST(octant_sweep, turns_rings_about_an_axis) {
  // Angles of a ring: ω = (a + ½) 2π/12. The rotation is towards ω = 0.
  const int angles = 12;
  const double width = 2.0 * std::numbers::pi / angles, stretch = 0.5 * width / std::sin(0.5 * width);
  auto config = apsis::velocity_config{4.0, 6};
  config.rings = 4;
  config.angles = angles;
  const auto equation = make_gas("bgk", 2, config, 3);
  gas_problem gas = gas_between_walls(equation, 2, 5, 1.0);
  gas.space->on({2, {5, 5, 1}, {0, 1, 0}, {1, 2, 1}});
  with_vacuum(gas, 2);
  const apsis::domain& space = gas.space->space();
  const apsis::cell_links links(space);
  const apsis::cut_links cut(space);
  const apsis::polar_layout rings = equation->polar();
  const apsis::ring_turn turn(rings, false);
  apsis::octant_sweep sweep(*equation, space, links, cut, slope, &turn);
  check_property("rounding", [&] {
    const drawn_step step(space.mesh().size(), equation->components());
    const auto& [r, rates] = step;
    field d = r;
    sweep.solve(gas.at_rest(), rates, d);
    field back = apply(*equation, space.mesh(), links, rates, d);
    for (int cell = 0; cell < r.cells(); ++cell)
      for (int k = 0; k < r.components(); ++k) {
        const int a = k / rings.apart % angles;
        const double speed = rings.speeds[static_cast<std::size_t>(k / (rings.apart * angles) % rings.rings)],
                     rate = speed * stretch / (space.mesh().centre(cell)[1] * width);
        const bool first_half = a < angles / 2;
        const int leaves = first_half ? a : a + 1, enters = first_half ? a + 1 : a,
                  from = first_half ? k + rings.apart : k - rings.apart;
        const auto sine = [&](int edge) { return std::abs(std::sin(edge * width)); };
        back.row(cell)[k] += rate * (sine(leaves) * d.row(cell)[k] - sine(enters) * d.row(cell)[from]);
        // Sums of some ten terms of size 1, times rates of rotation up to 6.
        RC_ASSERT(std::abs(back.row(cell)[k] - r.row(cell)[k]) < 1e-11);
      }
    expect_equal_bits_on_threads(sweep, gas.at_rest(), step, d);
  });
}

TEST(octant_sweep, keeps_uniform_gas_about_an_axis_in_first_order) {
  auto config = apsis::velocity_config{4.0, 6};
  config.rings = 4;
  config.angles = 12;
  const auto equation = make_gas("bgk", 2, config, 3);
  gas_problem gas = gas_between_walls(equation, 2, 5, 1.0);
  gas.space->with_axis(1);
  gas.space->with_boundary({1, false}, apsis::make_boundary("axis", *equation, {}));
  for (const apsis::face& where : {apsis::face{1, true}, {0, false}, {0, true}})
    gas.space->with_boundary(where, apsis::make_boundary("outflow", *equation, {}));
  const apsis::domain& space = gas.space->space();
  const apsis::cell_links links(space);
  const apsis::cut_links cut(space);
  const apsis::ring_turn turn(equation->polar(), false);
  apsis::octant_sweep sweep(*equation, space, links, cut, 0.0, &turn);
  const double rate = 0.5;
  field d(space.mesh().size(), equation->components());
  for (int cell = 0; cell < d.cells(); ++cell)
    std::fill_n(d.row(cell), d.components(), rate * space.mesh().centre(cell)[1]);
  sweep.solve(gas.at_rest(), std::vector<double>(static_cast<std::size_t>(d.cells()), rate), d);
  // F = r f of a uniform change of f is r, and L r = 0: the flux along r and the rotation cancel in every
  // cell, at the axis and at the outflow too. The rates of both are some hundred times that of collisions.
  for (int cell = 0; cell < d.cells(); ++cell)
    for (int k = 0; k < d.components(); ++k)
      ASSERT_NEAR(d.row(cell)[k], space.mesh().centre(cell)[1], 1e-12) << cell << " " << k;
}

INSTANTIATE_TEST_SUITE_P(in_space, sweeps, testing::Values(1, 2, 3));

TEST(octant_sweep, walls_return_in_later_octants_what_left_in_earlier_ones) {
  const auto equation = make_gas("bgk", 1, {5.0, 12}, 1);
  gas_problem gas = gas_between_walls(equation, 1, 6, 1.0);
  for (const bool upper : {false, true}) gas.space->with_boundary({0, upper}, diffuse_wall(*equation, 1.0));
  const apsis::domain& space = gas.space->space();
  const apsis::cell_links links(space);
  const apsis::cut_links cut(space);
  apsis::octant_sweep sweep(*equation, space, links, cut, slope);
  field d(6, equation->components());
  for (int k = 0; k < d.components(); ++k)
    d.row(3)[k] = equation->speeds(0)[static_cast<std::size_t>(k)] < 0.0;
  sweep.solve(gas.at_rest(), std::vector<double>(6, 1e-6), d);
  // Without collisions the molecules that fly to the left come back to the right, because no mass
  // crosses the wall.
  const auto weights = equation->velocities().weights();
  double leaving = 0.0, returning = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double v = equation->speeds(0)[k];
    (v < 0.0 ? leaving : returning) += weights[k] * std::abs(v) * d.row(0)[k];
  }
  EXPECT_GT(leaving, 0.1);
  EXPECT_NEAR(returning, leaving, 1e-5 * leaving);  // the rate of collisions is 1e-6
}

}  // namespace octant_sweep_test
