// The Broadwell model satisfies its equations.
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace broadwell_test {

namespace {

const apsis::relaxation_model& broadwell() {
  static const auto made = apsis::find_model("broadwell").make({});
  return dynamic_cast<const apsis::relaxation_model&>(*made);
}

/// Returns densities of any magnitude, including zeros.
std::vector<double> random_densities(int lowest_power, int highest_power) {
  std::vector<double> f(3);
  for (double& value : f)
    value = *rc::gen::inRange(0, 4) == 0 ? 0.0
                                         : (1.0 + 1e-6 * *rc::gen::inRange(0, 1000000)) *
                                               std::pow(10.0, *rc::gen::inRange(lowest_power, highest_power));
  return f;
}

}  // namespace

TEST(broadwell, rate_times_distance_from_equilibrium_is_the_collision_of_the_paper) {
  check_property("Q", [] {
    const auto& m = broadwell();
    const auto f = random_densities(-2, 2);
    double omega[2], e[3];
    m.moments(f.data(), omega);
    RC_ASSERT(m.equilibrium(omega, e));
    const double q = f[1] * f[1] - f[0] * f[2];
    const double scale = omega[0] * omega[0];
    const double sign[] = {1.0, -1.0, 1.0};
    // The tolerance covers about a dozen rounding errors of terms up to ρ².
    for (std::size_t k = 0; k < 3; ++k)
      RC_ASSERT(std::abs(m.rate(omega) * (e[k] - f[k]) - sign[k] * q) <= 1e-15 * scale);
  });
}

TEST(broadwell, equilibrium_of_any_nonnegative_densities_is_nonnegative_in_floating_point) {
  check_property("E >= 0", [] {
    const auto& m = broadwell();
    const auto f = random_densities(-320, 300);
    double omega[2], e[3];
    m.moments(f.data(), omega);
    RC_ASSERT(m.equilibrium(omega, e));
    RC_ASSERT(*std::min_element(e, e + 3) >= 0.0);
  });
}

TEST(broadwell, collisions_lower_the_entropy_and_equilibrium_is_its_minimum) {
  check_property("H", [] {
    const auto& m = broadwell();
    const auto f = random_densities(-3, 2);
    double omega[2], e[3];
    m.moments(f.data(), omega);
    RC_ASSERT(m.equilibrium(omega, e));
    const double start = m.entropy()->density(f.data()),
                 rounding = 1e-14 * omega[0] * (1.0 + std::abs(std::log(omega[0] + 1e-300)));
    // Every state with the same ω is f + s (1, −1, 1). The test checks dH/ds along Q, and H on the segment
    // from f to E.
    double previous = start;
    for (int k = 1; k <= 10; ++k) {
      std::vector<double> v(3);
      for (std::size_t j = 0; j < 3; ++j) v[j] = (1.0 - 0.1 * k) * f[j] + 0.1 * k * e[j];
      const double here = m.entropy()->density(v.data());
      RC_ASSERT(here <= previous + rounding);
      previous = here;
    }
    RC_ASSERT(std::abs(previous - m.entropy()->density(e)) <= rounding);
  });
}

TEST(broadwell, wrong_weights_would_not_decay) {
  // If particles at rest had weight 1, collisions that produce moving particles would increase the sum.
  const double f[] = {0.1, 1.0, 0.1}, q = f[1] * f[1] - f[0] * f[2];
  const auto slope = [&](double weight) {
    return q * (std::log(f[0]) + 1.0) - weight * q * (std::log(f[1]) + 1.0) + q * (std::log(f[2]) + 1.0);
  };
  EXPECT_LT(slope(2.0), 0.0);
  EXPECT_NEAR(slope(2.0), q * std::log(f[0] * f[2] / (f[1] * f[1])), 1e-14);
  // The entropy of the model has the slope for weight 2.
  const double h = 1e-6, along[] = {f[0] + h * q, f[1] - h * q, f[2] + h * q};
  EXPECT_NEAR((broadwell().entropy()->density(along) - broadwell().entropy()->density(f)) / h, slope(2.0),
              1e-4);
}

TEST(broadwell, data_of_the_riemann_problems_have_the_published_moments) {
  const auto& m = broadwell();
  const auto moments_at = [&m](const char* name, double x) {
    const auto found = std::find_if(m.initial().begin(), m.initial().end(),
                                    [name](const auto& data) { return data.name == name; });
    std::vector<double> f(3), values(6);
    found->point_value({x}, f);
    m.macroscopic(f.data(), values.data());
    values.resize(3);
    return values;
  };
  const auto expect = [](const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t k = 0; k < b.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-15);
  };
  expect(moments_at("riemann-1", 0.19), {2.0, 1.0, 1.0});
  expect(moments_at("riemann-1", 0.2), {1.0, 0.13962, 1.0});  // the value at the jump is that on the right
  expect(moments_at("riemann-2", -0.01), {1.0, 0.0, 1.0});
  expect(moments_at("riemann-2", 0.01), {0.2, 0.0, 1.0});
}

}  // namespace broadwell_test
