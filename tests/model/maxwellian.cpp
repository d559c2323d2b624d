#include <apsis/model/maxwellian.hpp>

#include <apsis/core/errors.hpp>

#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace maxwellian_test {

namespace {

using apsis::fluid_state;
using apsis::velocity_grid;

std::array<double, 5> moments_of(const fluid_state& s, int d) {
  std::array<double, 5> omega{};
  double square = 0.0;
  omega[0] = s.rho;
  for (int k = 0; k < d; ++k) {
    omega[static_cast<std::size_t>(1 + k)] = s.rho * s.u[k];
    square += s.u[k] * s.u[k];
  }
  omega[static_cast<std::size_t>(1 + d)] = 0.5 * s.rho * (square + d * s.T);
  return omega;
}

double defect(const velocity_grid& grid, const fluid_state& s, bool discrete) {
  apsis::aligned_vector<double> m(static_cast<std::size_t>(grid.size()));
  if (discrete) {
    if (!apsis::discrete_maxwellian(grid, s, m.data())) return 1.0;
  } else {
    apsis::formula_maxwellian(grid, s, m.data());
  }
  const auto omega = moments_of(s, grid.dimensions());
  return apsis::moment_defect(grid, m.data(), omega.data(), s);
}

}  // namespace

TEST(maxwellian, moments_and_states_are_inverse_to_each_other) {
  for (int d = 1; d <= 3; ++d) {
    const fluid_state s{1.3, {0.4, d > 1 ? -0.2 : 0.0, d > 2 ? 0.7 : 0.0}, 0.9};
    const auto omega = moments_of(s, d);
    const fluid_state back = apsis::to_fluid_state(omega.data(), d);
    EXPECT_NEAR(back.T, s.T, 1e-15);
    for (int k = 0; k < d; ++k) EXPECT_NEAR(back.u[k], s.u[k], 1e-15);
  }
}

TEST(maxwellian, formula_agrees_with_the_exponential_of_the_standard_library) {
  const velocity_grid grid(1, 150, 15.0);
  const fluid_state s{0.8, {0.4, 0, 0}, 1.5};
  apsis::aligned_vector<double> m(150);
  apsis::formula_maxwellian(grid, s, m.data());
  for (std::size_t j = 0; j < 150; ++j) {
    const double v = grid.line(0).v()[j];
    const double exact = s.rho / std::sqrt(2 * M_PI * s.T) * std::exp(-(v - 0.4) * (v - 0.4) / (2 * s.T));
    // The exponent, of magnitude up to 80, has a relative rounding error of 1e-16. Its magnitude amplifies
    // this error.
    EXPECT_NEAR(m[j] / exact, 1.0, 1e-13);
  }
}

TEST(maxwellian, formula_is_exact_to_rounding_on_the_grid_of_the_paper) {
  const velocity_grid grid(1, 150, 15.0);
  check_property("defect", [&] {
    const fluid_state s{*rc::gen::inRange(1, 100) * 0.1,
                        {*rc::gen::inRange(-20, 20) * 0.1, 0, 0},
                        *rc::gen::inRange(5, 25) * 0.1};
    RC_ASSERT(defect(grid, s, false) < 4e-15);  // sums of 150 terms
  });
}

TEST(maxwellian, discrete_maxwellian_conserves_on_coarse_grids_in_every_dimension) {
  for (int d = 1; d <= 3; ++d) {
    const velocity_grid grid(d, 12, 6.0);  // spacing 1, equal to √T
    check_property("defect", [&] {
      fluid_state s{*rc::gen::inRange(1, 100) * 0.1, {0, 0, 0}, *rc::gen::inRange(4, 20) * 0.1};
      for (int k = 0; k < d; ++k) s.u[k] = *rc::gen::inRange(-10, 10) * 0.1;
      RC_ASSERT(defect(grid, s, true) < 2e-14);
    });
    const fluid_state cold{1.0, {0.3, 0.1, 0}, 0.25};
    EXPECT_GT(defect(grid, cold, false), 1e-3) << "otherwise the grid is not coarse and the test is vacuous";
  }
}

TEST(maxwellian, discrete_maxwellian_is_positive_and_equals_the_formula_on_fine_grids) {
  const velocity_grid grid(1, 150, 15.0);
  const fluid_state s{1.0, {0.3, 0, 0}, 1.1};
  apsis::aligned_vector<double> formula(150), discrete(150);
  apsis::formula_maxwellian(grid, s, formula.data());
  ASSERT_TRUE(apsis::discrete_maxwellian(grid, s, discrete.data()));
  for (std::size_t j = 0; j < 150; ++j) {
    EXPECT_GT(discrete[j], 0.0);
    EXPECT_NEAR(discrete[j], formula[j], 1e-13);
  }
}

TEST(maxwellian, reports_moments_without_a_discrete_maxwellian) {
  const velocity_grid grid(1, 12, 6.0);
  apsis::aligned_vector<double> m(12);
  // The mean lies midway between grid points at distance 0.5, so the variance is at least 1/4.
  EXPECT_FALSE(apsis::discrete_maxwellian(grid, {1.0, {0.0, 0, 0}, 0.1}, m.data()));
  // The mean lies beyond the grid.
  EXPECT_FALSE(apsis::discrete_maxwellian(grid, {1.0, {7.0, 0, 0}, 1.0}, m.data()));
}

TEST(maxwellian, cold_tails_underflow_to_zero_not_to_nan) {
  const velocity_grid grid(1, 64, 50.0);
  apsis::aligned_vector<double> m(64);
  apsis::formula_maxwellian(grid, {1.0, {0, 0, 0}, 0.01}, m.data());
  EXPECT_EQ(m[0], 0.0);
  for (const double value : m) EXPECT_GE(value, 0.0);
}

TEST(velocity_grid, is_symmetric_and_refuses_invalid_extents) {
  const velocity_grid grid(2, 10, 3.0);
  EXPECT_EQ(grid.size(), 100);
  EXPECT_EQ(grid.line(0).v()[0], -grid.line(0).v()[9]);
  EXPECT_THROW(velocity_grid(4, 10, 3.0), apsis::input_error);
  EXPECT_THROW(velocity_grid(1, 2, 3.0), apsis::input_error);
  EXPECT_THROW(velocity_grid(1, 10, -1.0), apsis::input_error);
}

TEST(maxwellian, sums_in_two_and_three_dimensions_keep_the_tails) {
  // A naive sum drops every term below half a unit in the last place of the partial sum. Here these are 9 of
  // 10 terms. The loss of 1e-15 to 1e-14 has the same sign for every state.
  for (const int d : {2, 3}) {
    const velocity_grid grid(d, d == 2 ? 150 : 32, d == 2 ? 15.0 : 10.0);
    fluid_state state;
    state.rho = 1.0;
    state.T = 1.0;
    for (const double u : {-0.3, 0.0, 0.17, 0.5}) {
      state.u[0] = u;
      std::vector<double> m(static_cast<std::size_t>(grid.size()));
      apsis::formula_maxwellian(grid, state, m.data());
      double omega[5];
      apsis::kinetic_moments(grid, m.data(), omega);
      long double mass = 0.0L, energy = 0.0L;
      for (std::size_t j = 0; j < m.size(); ++j) {
        mass += m[j];
        energy += static_cast<long double>(grid.half_square()[j]) * m[j];
      }
      // The tolerance covers a few rounding errors of 1.1e-16. A long double has 11 more bits.
      EXPECT_NEAR(omega[0], static_cast<double>(mass * grid.weight()), 4.5e-16) << d << " " << u;
      EXPECT_NEAR(omega[d + 1] / static_cast<double>(energy * grid.weight()), 1.0, 6e-16) << d << " " << u;
    }
  }
}

}  // namespace maxwellian_test
