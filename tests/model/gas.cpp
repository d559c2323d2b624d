// A gas with more degrees of freedom than velocity dimensions (Chu's reduction). Its moments agree with their
// definitions and with a gas whose velocity grid resolves all degrees of freedom.
#include <apsis/model/gas.hpp>

#include <apsis/core/errors.hpp>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/bad_input.hpp>

namespace gas_test {

namespace {

using apsis::gas;
using apsis::input_error;

gas make_gas(int dimensions, int degrees, int points = 24, double max = 9.0) {
  apsis::model_config config;
  config.parameters = {{"velocity_dimensions", dimensions}, {"degrees_of_freedom", degrees}};
  config.velocity = {max, points, apsis::equilibrium_choice::automatic};
  return gas(config);
}

/// Returns the sum of two Maxwellians with different velocities and temperatures, with h off equilibrium.
std::vector<double> random_row(const gas& of) {
  const auto number = [](int low, int high) { return *rc::gen::inRange(low, high) / 100.0; };
  std::vector<double> sum(static_cast<std::size_t>(of.velocities().components()), 0.0), row(sum.size());
  for (int beam = 0; beam < 2; ++beam) {
    apsis::fluid_state s;
    s.rho = number(10, 200);
    s.T = number(60, 150);
    for (int k = 0; k < of.dimensions(); ++k) s.u[k] = number(-100, 100);
    of.formula(s, 1.0, row.data());
    const double factor = number(10, 300);
    for (std::size_t j = 0; j < row.size(); ++j)
      sum[j] += (j < static_cast<std::size_t>(of.grid().size()) ? 1.0 : factor) * row[j];
  }
  return sum;
}

std::vector<double> omega_of(const gas& of, const std::vector<double>& row) {
  std::vector<double> omega(static_cast<std::size_t>(of.moment_count()));
  of.moments(row.data(), 0, 1, omega.data());
  return omega;
}

}  // namespace

RC_GTEST_PROP(gas, has_no_equilibrium_at_negative_temperatures, ()) {
  const int d = *rc::gen::inRange(1, 4), degrees = d + *rc::gen::inRange(1, 4);
  const gas of = make_gas(d, degrees, 24, 9.0);
  std::vector<double> row(static_cast<std::size_t>(of.velocities().components()));
  std::vector<double> omega(static_cast<std::size_t>(of.moment_count()), 0.0);
  omega[0] = *rc::gen::element(1e-12, 1.0, 1e12);
  const auto exists = [&](double T) {
    omega.back() = 0.5 * degrees * omega[0] * T;
    return of.equilibrium(omega.data(), row.data());
  };
  for (const double T : {-1.0, -1e-6, std::numeric_limits<double>::quiet_NaN()}) {
    RC_ASSERT(!exists(T));
    RC_ASSERT(!of.why_inadmissible(omega.data()).empty());
  }
  RC_ASSERT(exists(0.0));  // the moments of molecules with one velocity
  RC_ASSERT(exists(1.0));
  const auto again = omega_of(of, row);
  RC_ASSERT(std::abs(again.back() - omega.back()) <= 1e-12 * omega.back());
}

RC_GTEST_PROP(gas, moments_are_sums_over_g_and_h, ()) {
  const int d = *rc::gen::inRange(1, 4);
  const gas of = make_gas(d, 3 + *rc::gen::inRange(0, 3), 12);
  const auto row = random_row(of);
  const auto omega = omega_of(of, row);
  const std::size_t n = static_cast<std::size_t>(of.grid().size());
  long double mass = 0, energy = 0;
  for (std::size_t j = 0; j < n; ++j) {
    long double square = 0;
    for (int k = 0; k < d; ++k) square += std::pow(static_cast<long double>(of.grid().component(k)[j]), 2);
    mass += row[j];
    energy += 0.5L * square * row[j] + (of.reduced() ? 0.5L * row[n + j] : 0.0L);
  }
  // The moments are sums of up to 12³ terms.
  RC_ASSERT(std::abs(omega[0] - static_cast<double>(mass) * of.grid().weight()) < 1e-14 * omega[0]);
  const double total = omega[static_cast<std::size_t>(d) + 1];
  RC_ASSERT(std::abs(total - static_cast<double>(energy) * of.grid().weight()) < 1e-14 * total);
}

RC_GTEST_PROP(gas, equilibrium_has_the_moments_and_minimizes_the_entropy, ()) {
  const int d = *rc::gen::inRange(1, 3);
  const gas of = make_gas(d, *rc::gen::inRange(d, 7));
  const auto row = random_row(of);
  const auto omega = omega_of(of, row);
  std::vector<double> e(row.size());
  RC_ASSERT(of.equilibrium(omega.data(), e.data()));
  const auto again = omega_of(of, e);
  for (std::size_t k = 0; k < omega.size(); ++k)
    RC_ASSERT(std::abs(again[k] - omega[k]) < 4e-14 * (omega[0] + omega.back()));
  const double h_row = of.entropy(row.data()), h_e = of.entropy(e.data());
  RC_ASSERT(h_e <= h_row + 1e-12 * (1.0 + std::abs(h_row)));
  // The entropy is convex along the line from the row to its equilibrium.
  std::vector<double> middle(row.size());
  for (std::size_t j = 0; j < row.size(); ++j) middle[j] = 0.5 * (row[j] + e[j]);
  RC_ASSERT(of.entropy(middle.data()) <= 0.5 * (h_row + h_e) + 1e-12 * (1.0 + std::abs(h_row)));
}

RC_GTEST_PROP(gas, every_nonnegative_row_has_an_equilibrium_with_its_moments, ()) {
  // The rows are sparse, with g and h of any size. Temperatures are far below and above those that
  // g can have.
  const int d = *rc::gen::inRange(1, 4);
  const gas of = make_gas(d, 3 + *rc::gen::inRange(0, 3), d == 3 ? 6 : 10);
  const auto n = static_cast<std::size_t>(of.grid().size());
  std::vector<double> row(2 * n, 0.0), e(2 * n);
  const double scale_of_h = std::pow(10.0, *rc::gen::inRange(-12, 13));
  const int points = *rc::gen::inRange(1, 6);
  for (int k = 0; k < points; ++k) {
    row[*rc::gen::inRange<std::size_t>(0, n)] += *rc::gen::inRange(1, 100) / 50.0;
    row[n + *rc::gen::inRange<std::size_t>(0, n)] += scale_of_h * *rc::gen::inRange(0, 100);
  }
  const auto omega = omega_of(of, row);
  RC_ASSERT(of.equilibrium(omega.data(), e.data()));
  for (const double value : e) RC_ASSERT(value >= 0.0);
  const auto after = omega_of(of, e);
  const auto size = static_cast<std::size_t>(of.moment_count());
  const double speed = std::sqrt(2.0 * omega[size - 1] / omega[0]);
  for (std::size_t k = 0; k < size; ++k) {
    const double scale = k + 1 == size ? omega[k] : omega[0] * (k == 0 ? 1.0 : std::max(speed, 1.0));
    // Newton's method ends at a few units in the last place of the largest term.
    RC_ASSERT(std::abs(after[k] - omega[k]) <= 1e-13 * scale);
  }
}

TEST(gas, batches_of_rows_give_the_bits_of_single_rows) {
  const gas of = make_gas(1, 3);
  const std::size_t rows = 37, width = static_cast<std::size_t>(of.velocities().components()),
                    pitch = width + 8;
  std::vector<double> f(rows * pitch, 7.0), e(rows * pitch, 7.0), one(width), omega(rows * 3);
  for (std::size_t p = 0; p < rows; ++p) {
    apsis::fluid_state s;
    s.rho = 0.5 + 0.1 * static_cast<double>(p);
    s.u[0] = 0.02 * static_cast<double>(p);
    s.T = 1.5 - 0.03 * static_cast<double>(p);
    of.formula(s, 1.0, f.data() + p * pitch);
  }
  of.moments(f.data(), static_cast<std::ptrdiff_t>(pitch), static_cast<int>(rows), omega.data());
  ASSERT_EQ(of.equilibria(omega.data(), static_cast<int>(rows), e.data(), static_cast<std::ptrdiff_t>(pitch)),
            static_cast<int>(rows));
  for (std::size_t p = 0; p < rows; ++p) {
    double single[3];
    of.moments(f.data() + p * pitch, 0, 1, single);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(single[k], omega[3 * p + k]);
    ASSERT_TRUE(of.equilibrium(single, one.data()));
    for (std::size_t j = 0; j < width; ++j) EXPECT_EQ(one[j], e[p * pitch + j]);
    EXPECT_EQ(e[p * pitch + width], 7.0) << "padding between the rows is left alone";
  }
}

TEST(gas, vacuum_is_its_own_equilibrium) {
  const gas of = make_gas(1, 3);
  const std::vector<double> omega = {0.0, 0.0, 0.0};
  std::vector<double> e(static_cast<std::size_t>(of.velocities().components()), 1.0);
  ASSERT_TRUE(of.equilibrium(omega.data(), e.data()));
  for (const double value : e) EXPECT_EQ(value, 0.0);
}

TEST(gas, with_as_many_degrees_of_freedom_as_dimensions_has_one_set) {
  EXPECT_FALSE(make_gas(2, 0).reduced());
  EXPECT_FALSE(make_gas(2, 2).reduced());
  EXPECT_EQ(make_gas(2, 3).velocities().sets(), 2);
  EXPECT_EQ(make_gas(2, 3).velocities().components(), 2 * 24 * 24);
  bad_input::expect_refused({{[&] { make_gas(3, 2, 8); },
                              {"model.degrees_of_freedom = 2 is below model.velocity_dimensions = 3"}}});
}

}  // namespace gas_test
