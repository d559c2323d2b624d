// Velocities on rings about an axis, and the discrete Maxwellian at these velocities.
#include <apsis/model/polar_maxwellian.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/random_source.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/model/velocity_support.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace polar_maxwellian_test {

namespace {

using apsis::random_source;
using apsis::velocity_grid;
using row = apsis::aligned_vector<double>;

velocity_grid rings_about(int along, int rings = 10, int angles = 24, int axial = 14, double max = 6.0) {
  return {apsis::velocity_line(axial, max), apsis::polar_rings(rings, angles, max), along};
}

velocity_grid random_grid(random_source& random) {
  return rings_about(random.one_in(2) ? 0 : 2, random.integer(4, 12), 4 * random.integer(3, 9),
                     random.integer(4, 16), random.magnitude(-1, 2));
}

std::array<double, 5> moments_of(const velocity_grid& grid, const row& f) {
  std::array<double, 5> omega{};
  apsis::kinetic_moments(grid, f.data(), omega.data());
  return omega;
}

/// Returns the largest difference of moments in units of ρ, of ρ√⟨v²⟩ and of the energy.
double difference(const std::array<double, 5>& a, const std::array<double, 5>& b) {
  const double speed = std::sqrt(2.0 * b[4] / b[0]);
  double largest = std::max(std::abs(a[0] - b[0]) / b[0], std::abs(a[4] - b[4]) / b[4]);
  for (std::size_t k = 1; k < 4; ++k) largest = std::max(largest, std::abs(a[k] - b[k]) / (b[0] * speed));
  return largest;
}

/// Returns the difference between the moments of a row and of its equilibrium. The equilibrium must exist and
/// be nonnegative.
double change_of_moments(const velocity_grid& grid, const row& f) {
  const auto omega = moments_of(grid, f);
  row m(f.size());
  EXPECT_TRUE(apsis::discrete_maxwellian(grid, omega.data(), m.data()))
      << apsis::why_unrealizable(grid, omega.data());
  EXPECT_GE(*std::min_element(m.begin(), m.end()), 0.0);
  return difference(moments_of(grid, m), omega);
}

/// Returns the Gaussian at the velocities. Its sums are not the moments of the state.
row gaussian(const velocity_grid& grid, const apsis::fluid_state& state) {
  row f(static_cast<std::size_t>(grid.size()));
  apsis::formula_maxwellian(grid, state, f.data());
  return f;
}

double entropy(const velocity_grid& grid, const row& f) {
  double sum = 0.0;
  for (std::size_t j = 0; j < f.size(); ++j)
    if (f[j] > 0.0) sum += grid.set().weights()[j] * f[j] * std::log(f[j]);
  return sum;
}

}  // namespace

TEST(polar_rings, have_mirror_images_of_equal_bits) {
  for (const int angles : {12, 16, 36, 64}) {
    const apsis::polar_rings rings(5, angles, 3.0);
    for (int a = 0; a < angles; ++a) {
      EXPECT_EQ(rings.cosine(a), rings.cosine(-1 - a));
      EXPECT_EQ(rings.cosine(a), -rings.cosine(angles / 2 - 1 - a));
      EXPECT_NEAR(rings.cosine(a), std::cos((a + 0.5) * 2.0 * std::numbers::pi / angles), 1e-15);
    }
  }
}

TEST(polar_rings, integrate_smooth_functions_with_fourth_order) {
  const auto error = [](int rings) {
    const apsis::polar_rings of(rings, 12, 7.0);
    double sum = 0.0;
    for (int ring = 0; ring < rings; ++ring)
      sum += 12.0 * of.weight(ring) * std::exp(-0.5 * of.speed(ring) * of.speed(ring));
    return std::abs(sum / (2.0 * std::numbers::pi) - 1.0);
  };
  EXPECT_NEAR(std::log2(error(16) / error(32)), 4.0, 0.2);
  EXPECT_LT(error(32), 1e-5);
}

TEST(polar_rings, refuse_numbers_without_mirror_images) {
  const auto message = [](int rings, int angles, double max) -> std::string {
    try {
      apsis::polar_rings(rings, angles, max);
    } catch (const apsis::input_error& problem) {
      return problem.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(3, 12, 1.0).find("velocity.rings = 3"), 0U);
  EXPECT_EQ(message(4, 14, 1.0).find("velocity.angles = 14"), 0U);
  EXPECT_NE(message(4, 14, 1.0).find("give 16"), std::string::npos);
  EXPECT_NE(message(4, 8, 1.0).find("give 12"), std::string::npos);
  EXPECT_EQ(message(4, 12, -1.0).find("velocity.max_across = -1"), 0U);
  EXPECT_THROW(rings_about(0, 1 << 12, 1 << 12, 1 << 12), apsis::input_error);
}

TEST(polar_maxwellian, has_the_moments_of_every_positive_row) {
  random_source random(1);
  for (int trial = 0; trial < 300; ++trial) {
    const velocity_grid grid = random_grid(random);
    row f(static_cast<std::size_t>(grid.size()));
    const double decades = random.uniform(0.0, 6.0), size = random.magnitude(-200, 200);
    for (double& x : f) x = size * std::pow(10.0, -decades * random.uniform());
    ASSERT_LT(change_of_moments(grid, f), 1e-13) << trial;  // sums of thousands of terms
  }
}

TEST(polar_maxwellian, has_the_moments_of_few_molecules) {
  random_source random(2);
  for (int trial = 0; trial < 1000; ++trial) {
    const velocity_grid grid = random_grid(random);
    row f(static_cast<std::size_t>(grid.size()));
    for (int left = random.integer(1, 6); left > 0; --left)
      f[static_cast<std::size_t>(random.integer(0, grid.size()))] =
          random.uniform(1e-3, 1.0) * (random.one_in(3) ? 1e-12 : 1.0);
    ASSERT_LT(change_of_moments(grid, f), 1e-12) << trial;
  }
}

TEST(polar_maxwellian, minimizes_the_entropy) {
  random_source random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const velocity_grid grid = random_grid(random);
    row f(static_cast<std::size_t>(grid.size())), m(f.size());
    for (double& x : f) x = random.uniform(0.01, 1.0);
    ASSERT_TRUE(apsis::discrete_maxwellian(grid, moments_of(grid, f).data(), m.data()));
    EXPECT_LT(entropy(grid, m), entropy(grid, f));
    // log m is a combination of 1, v and |v|².
    Eigen::MatrixXd functions(grid.size(), 5);
    Eigen::VectorXd logarithm(grid.size());
    for (int j = 0; j < grid.size(); ++j) {
      const auto at = static_cast<std::size_t>(j);
      functions.row(j) << 1.0, grid.component(0)[at], grid.component(1)[at], grid.component(2)[at],
          grid.half_square()[at];
      logarithm[j] = std::log(m[at]);
    }
    const Eigen::VectorXd scaled = functions.colwise().norm().cwiseInverse();
    const Eigen::MatrixXd unit = functions * scaled.asDiagonal();
    const Eigen::VectorXd rest = logarithm - unit * unit.colPivHouseholderQr().solve(logarithm);
    EXPECT_LT(rest.cwiseAbs().maxCoeff(), 1e-10 * (1.0 + logarithm.cwiseAbs().maxCoeff()));
  }
}

TEST(polar_maxwellian, converges_to_the_formula_with_fourth_order) {
  apsis::fluid_state state;
  state.rho = 0.7;
  state.T = 1.2;
  state.u[0] = 0.3;
  state.u[1] = 0.2;
  state.u[2] = -0.4;
  const auto error = [&](int along, int rings) {
    const velocity_grid grid = rings_about(along, rings, 32, 24, 8.0);
    const row exact = gaussian(grid, state);
    row m(exact.size());
    EXPECT_TRUE(apsis::discrete_maxwellian(grid, state, m.data()));
    double largest = 0.0;
    for (std::size_t j = 0; j < m.size(); ++j) largest = std::max(largest, std::abs(m[j] - exact[j]));
    return largest;
  };
  for (const int along : {0, 2}) {
    EXPECT_NEAR(std::log2(error(along, 16) / error(along, 32)), 4.0, 0.3);
    EXPECT_LT(error(along, 32), 1e-5);
  }
}

TEST(polar_maxwellian, depends_on_the_axis_only_by_the_names_of_components) {
  const velocity_grid first = rings_about(0), third = rings_about(2);
  random_source random(4);
  row f(static_cast<std::size_t>(first.size())), a(f.size()), b(f.size());
  for (double& x : f) x = random.uniform();
  const auto of_first = moments_of(first, f), of_third = moments_of(third, f);
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 3}, {2, 1}, {3, 2}, {4, 4}})
    EXPECT_EQ(of_first[static_cast<std::size_t>(x)], of_third[static_cast<std::size_t>(y)]);
  ASSERT_TRUE(apsis::discrete_maxwellian(first, of_first.data(), a.data()));
  ASSERT_TRUE(apsis::discrete_maxwellian(third, of_third.data(), b.data()));
  for (std::size_t j = 0; j < f.size(); ++j) EXPECT_NEAR(a[j], b[j], 1e-13);
}

TEST(polar_maxwellian, of_a_vacuum_is_zero_and_other_moments_have_reasons) {
  const velocity_grid grid = rings_about(0);
  row m(static_cast<std::size_t>(grid.size()), 1.0);
  std::array<double, 5> omega{};
  ASSERT_TRUE(apsis::discrete_maxwellian(grid, omega.data(), m.data()));
  EXPECT_EQ(*std::max_element(m.begin(), m.end()), 0.0);
  const auto reason = [&](const std::array<double, 5>& of) {
    EXPECT_FALSE(apsis::discrete_maxwellian(grid, of.data(), m.data()));
    return apsis::why_unrealizable(grid, of.data());
  };
  EXPECT_EQ(reason({-1.0, 0.0, 0.0, 0.0, 1.0}), "density -1 is not positive");
  EXPECT_EQ(reason({1.0, 0.0, 0.0, 0.0, -1.5}), "temperature -1 is not positive");
  EXPECT_EQ(reason({1.0, NAN, 0.0, 0.0, 1.0}), "a moment is not finite");
  EXPECT_EQ(reason({1.0, 0.0, 0.0, 0.0, 1e4}).find("no f >= 0 on the 10 rings of 24 velocities"), 0U);
}

TEST(polar_maxwellian, velocities_are_supported_as_far_as_their_sums_reach) {
  auto parts = apsis::default_config(apsis::find_model("bgk"));
  parts.velocity = {.max = 6.0, .points = 16, .rings = 12, .angles = 24};
  const apsis::gas of(parts);
  const apsis::velocity_support support(of);
  apsis::fluid_state state;
  state.rho = state.T = 1.0;
  EXPECT_LT(support.fit(state).missed, apsis::velocity_limits::good);
  state.u[0] = 4.0;  // across the axis of the line (r, theta, x)
  EXPECT_TRUE(support.fit(state).ends);
  EXPECT_GT(support.fit(state).missed, 0.1);
  state.u[0] = 0.0;
  state.T = 0.01;
  EXPECT_FALSE(support.fit(state).ends);
  EXPECT_GT(support.fit(state).missed, 0.1);
}

TEST(polar_maxwellian, molecules_with_inner_energy_have_its_share) {
  auto parts = apsis::default_config(apsis::find_model("bgk"));
  parts.velocity = {.max = 6.0, .points = 16, .rings = 12, .angles = 24};
  parts.parameters["degrees_of_freedom"] = 5;
  const apsis::gas of(parts);
  const auto n = static_cast<std::size_t>(of.grid().size());
  random_source random(5);
  row f(2 * n), m(f.size());
  for (std::size_t j = 0; j < n; ++j) {
    f[j] = std::exp(-0.5 * of.grid().half_square()[j]) * random.uniform();
    f[n + j] = f[j] * random.uniform(0.5, 3.0);
  }
  std::array<double, 5> before{}, after{};
  of.moments(f.data(), 0, 1, before.data());
  ASSERT_TRUE(of.equilibrium(before.data(), m.data()));
  of.moments(m.data(), 0, 1, after.data());
  EXPECT_LT(difference(after, before), 1e-13);
  for (std::size_t j = 0; j < n; ++j)
    EXPECT_NEAR(m[n + j], 2.0 * of.state(before.data()).T * m[j], 1e-14 * m[n + j]);
}

TEST(polar_maxwellian, more_dimensions_of_space_are_refused) {
  const auto message = [](auto change) -> std::string {
    auto parts = apsis::default_config(apsis::find_model("bgk"));
    parts.velocity = {.max = 6.0, .points = 16, .rings = 12, .angles = 24};
    change(parts);
    try {
      const apsis::gas made(parts);
    } catch (const apsis::input_error& problem) {
      return problem.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message([](auto& parts) {
              parts.parameters["velocity_dimensions"] = 2;
            }).find("model.velocity_dimensions = 2"),
            0U);
  EXPECT_EQ(message([](auto& parts) {
              parts.space_dimensions = 3;
            }).find("axisymmetric flow in 3 space dimensions"),
            0U);
  EXPECT_EQ(message([](auto&) {}), "accepted");
}

}  // namespace polar_maxwellian_test
