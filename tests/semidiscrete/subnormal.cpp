// Nonnegativity where rounding errors are absolute, for values that are small multiples of 4.9e-324.
#include "bgk_case.hpp"

#include <apsis/core/random_source.hpp>
#include <apsis/model/relaxation_rows.hpp>
#include <apsis/scheme/limiter.hpp>
#include <apsis/scheme/quartic.hpp>
#include <apsis/semidiscrete/collision_rows.hpp>

#include <support/instruction_sets.hpp>

namespace subnormal_test {

namespace {

using apsis::field;
using apsis::grid;
using limits = apsis::limited_reconstruction::limits;

constexpr double unit = std::numeric_limits<double>::denorm_min();

/// Returns zero, a few units, a power of two between 1 unit and 1e-285, or a number of ordinary magnitude.
double tiny_value(apsis::random_source& random) {
  const double kind = random.uniform(0.0, 1.0);
  if (kind < 0.2) return 0.0;
  if (kind < 0.6) return unit * std::floor(random.uniform(1.0, 60.0));
  if (kind < 0.95)
    return std::ldexp(random.uniform(1.0, 2.0), static_cast<int>(random.uniform(-1074.0, -947.0)));
  return random.uniform(0.5, 2.0);
}

field tiny_rows(int cells, int components, apsis::random_source& random) {
  field u(cells, components);
  for (int i = 0; i < cells; ++i)
    for (int k = 0; k < components; ++k) u.row(i)[k] = tiny_value(random);
  return u;
}

/// Returns α u + β T(u) with the largest β for which the limiter ensures nonnegativity. α is 1, or as small
/// as weights of methods can be.
field longest_step(apsis::transport& t, const field& u, double alpha, double share, bool fresh) {
  t.limit_for_steps(share);
  field result(u.cells(), u.components());
  const apsis::target<field, double> to{&result, alpha, alpha * share * t.forward_euler_step(), fresh};
  t.add_transport(0.0, u, {&to, 1});
  return result;
}

double smallest_unknown(const field& u) {
  double lowest = u.row(0)[0];
  for (int i = 0; i < u.cells(); ++i)
    for (int k = 0; k < u.components(); ++k) lowest = std::min(lowest, u.row(i)[k]);
  return lowest;
}

/// Returns cells with |v|/Δx from 1e-8 to 1e8, similar along different directions. If it is small, products
/// of subnormal numbers are rounded. If it is large, they are exact.
grid random_mesh(int dimensions, int cells, apsis::random_source& random) {
  const double size = std::pow(10.0, random.uniform(-8.0, 8.0));
  std::array<int, 3> count = {1, 1, 1};
  std::array<double, 3> upper = {1.0, 1.0, 1.0};
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k) {
    count[k] = k == 0 ? cells : 5;
    upper[k] = size * count[k] * random.uniform(0.5, 1.5);
  }
  return {dimensions, count, {0.0, 0.0, 0.0}, upper};
}

void expect_nonnegative_steps(const std::string& name, limits kind, int dimensions, int rounds) {
  apsis::random_source random(11);
  for (int round = 0; round < rounds; ++round) {
    const grid mesh = random_mesh(dimensions, 11 + round % 7, random);
    const auto m = small_bgk(dimensions == 1 ? 10 : 4, 8.0, dimensions);
    auto t = upwind(*m, space_of(mesh), scheme(name, kind));
    const field u = tiny_rows(mesh.size(), m->components(), random);
    const double share = round % 5 < 3 ? 1.0 : std::pow(10.0, random.uniform(-5.0, 0.0));
    const double alpha = round % 3 == 0 ? 1.0 : std::pow(10.0, random.uniform(-8.0, 0.0));
    ASSERT_GE(smallest_unknown(longest_step(t, u, alpha, share, round % 2 == 0)), 0.0)
        << name << ", " << dimensions << " dimensions, round " << round << ", alpha " << alpha << ", share "
        << share;
  }
}

}  // namespace

TEST(subnormal, the_largest_step_keeps_every_value_nonnegative_in_every_instruction_set) {
  for_each_instruction_set([] {
    for (const auto* const name : {"weno5-z", "weno5-js", "teno5"})
      for (const auto kind : {limits::edges, limits::fluxes}) expect_nonnegative_steps(name, kind, 1, 400);
    expect_nonnegative_steps("upwind1", limits::nothing, 1, 400);
  });
}

TEST(subnormal, the_largest_step_keeps_every_value_nonnegative_in_several_dimensions) {
  for_each_instruction_set([] {
    for (const int dimensions : {2, 3}) {
      expect_nonnegative_steps("weno5-z", limits::fluxes, dimensions, 20);
      expect_nonnegative_steps("upwind1", limits::nothing, dimensions, 20);
    }
  });
}

TEST(subnormal, a_step_beyond_the_bound_gives_a_negative_value) {
  // Two cells of ordinary magnitude lie in a vacuum. The edge between them is above the value of the first
  // one. At the bound its fluxes empty it.
  const grid mesh = grid::line(20, 0.0, 1.0);
  const auto m = small_bgk(10);
  field u(20, m->components());
  for (int k = 0; k < m->components(); ++k) {
    u.row(9)[k] = 1.0;
    u.row(10)[k] = 5.0;
  }
  for (const auto& [name, kind] : {std::pair{"upwind1", limits::nothing}, {"weno5-z", limits::fluxes}}) {
    const auto t = upwind(*m, space_of(mesh), scheme(name, kind));
    field result(20, m->components());
    const apsis::target<field, double> to{&result, 1.0, 1.001 * t.forward_euler_step(), true};
    t.add_transport(0.0, u, {&to, 1});
    EXPECT_LT(smallest_unknown(result), 0.0) << name;
  }
}

TEST(subnormal, limited_values_at_gauss_points_are_nonnegative_and_keep_their_mean) {
  for_each_instruction_set([] {
    apsis::random_source random(5);
    constexpr int width = 8;
    std::vector<double> points(3 * width);
    for (int round = 0; round < 4000; ++round) {
      const field u = tiny_rows(5, width, random);
      apsis::collision_rows::gauss_values({u.row(0), u.row(1), u.row(2), u.row(3), u.row(4)}, true, width,
                                          points.data());
      for (int k = 0; k < width; ++k) {
        const double c = u.row(1)[k];
        double mean = 0.0;
        for (int p = 0; p < 3; ++p) {
          const double value = points[static_cast<std::size_t>(p * width + k)];
          ASSERT_GE(value, 0.0) << round << " " << k;
          mean += apsis::gauss3::weight[static_cast<std::size_t>(p)] * value;
        }
        // Values of up to 20 c have relative rounding errors. Three products and the values are rounded to
        // multiples of the unit.
        ASSERT_NEAR(mean, c, 1e-14 * c + 4.0 * unit);
      }
    }
  });
}

TEST(subnormal, an_explicit_relaxation_step_leaves_nonnegative_values) {
  for_each_instruction_set([] {
    apsis::random_source random(3);
    constexpr int width = 8;
    for (int round = 0; round < 4000; ++round) {
      const field u = tiny_rows(2, width, random);
      const double alpha = random.uniform(0.01, 1.0), of_transport = random.uniform(0.0, 1.0);
      field acc(1, width);
      // A step of transport at its limit is followed by relaxation with the remaining part of the bound.
      for (int k = 0; k < width; ++k) acc.row(0)[k] = alpha * (1.0 - of_transport) * u.row(0)[k];
      const double strength = std::pow(10.0, random.uniform(-3.0, 9.0));
      const double beta = apsis::rounding_allowance * alpha * (1.0 - of_transport) / strength;
      const std::vector<apsis::upwind::row_target> to = {{acc.row(0), width, 0.0, beta, false}};
      std::array<double, width> q{};
      apsis::relaxation::change(strength, u.row(1), u.row(0), width, q.data());
      const apsis::collision_rows::weighted_row point{1.0, q.data()};
      apsis::collision_rows::add({&point, 1}, u.row(0), width, to);
      for (int k = 0; k < width; ++k) ASSERT_GE(acc.row(0)[k], 0.0) << round << " " << k;
    }
  });
}

}  // namespace subnormal_test
