// Broadwell's model in the plane agrees with its collision and with the model on a line.
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace broadwell_plane_test {

namespace {

const apsis::relaxation_model& called(const char* name) {
  static std::map<std::string, std::unique_ptr<apsis::model>> made;
  auto& one = made[name];
  if (!one) one = apsis::find_model(name).make({});
  return dynamic_cast<const apsis::relaxation_model&>(*one);
}

/// Returns densities of any magnitude, including zeros.
std::array<double, 4> random_densities(int lowest_power, int highest_power) {
  std::array<double, 4> f{};
  for (double& value : f)
    value = *rc::gen::inRange(0, 4) == 0 ? 0.0
                                         : (1.0 + 1e-6 * *rc::gen::inRange(0, 1000000)) *
                                               std::pow(10.0, *rc::gen::inRange(lowest_power, highest_power));
  return f;
}

struct equilibrium {
  std::array<double, 3> omega{};
  std::array<double, 4> e{};

  explicit equilibrium(const std::array<double, 4>& f) {
    called("broadwell-plane").moments(f.data(), omega.data());
    RC_ASSERT(called("broadwell-plane").equilibrium(omega.data(), e.data()));
  }
};

}  // namespace

TEST(broadwell_plane, rate_times_distance_from_equilibrium_is_the_collision) {
  check_property("Q", [] {
    const auto f = random_densities(-2, 2);
    const equilibrium of(f);
    const double q = f[2] * f[3] - f[0] * f[1];
    const std::array<double, 4> sign = {1.0, 1.0, -1.0, -1.0};
    // The tolerance covers about twenty rounding errors of terms up to ρ².
    for (std::size_t k = 0; k < 4; ++k)
      RC_ASSERT(std::abs(of.omega[0] * (of.e[k] - f[k]) - sign[k] * q) <= 3e-15 * of.omega[0] * of.omega[0]);
  });
}

TEST(broadwell_plane, equilibrium_is_nonnegative_and_has_the_moments) {
  check_property("E >= 0", [] {
    const auto f = random_densities(-300, 300);
    const equilibrium of(f);
    RC_ASSERT(*std::min_element(of.e.begin(), of.e.end()) >= 0.0);
    std::array<double, 3> again{};
    called("broadwell-plane").moments(of.e.data(), again.data());
    for (std::size_t k = 0; k < 3; ++k) RC_ASSERT(std::abs(again[k] - of.omega[k]) <= 4.5e-16 * of.omega[0]);
  });
}

TEST(broadwell_plane, entropy_falls_from_any_densities_to_equilibrium) {
  check_property("H", [] {
    const auto f = random_densities(-3, 2);
    const equilibrium of(f);
    const auto& m = called("broadwell-plane");
    const double rounding = 1e-14 * of.omega[0] * (1.0 + std::abs(std::log(of.omega[0] + 1e-300)));
    double previous = m.entropy()->density(f.data());
    for (int part = 1; part <= 10; ++part) {
      std::array<double, 4> v{};
      for (std::size_t k = 0; k < 4; ++k) v[k] = (1.0 - 0.1 * part) * f[k] + 0.1 * part * of.e[k];
      const double here = m.entropy()->density(v.data());
      RC_ASSERT(here <= previous + rounding);
      previous = here;
    }
  });
}

TEST(broadwell_plane, with_equal_densities_along_y_is_the_model_on_a_line) {
  check_property("line", [] {
    auto f = random_densities(-3, 3);
    f[3] = f[2];
    const equilibrium of(f);
    const std::array<double, 3> line = {f[0], f[2], f[1]};
    std::array<double, 2> omega{};
    std::array<double, 3> e{};
    called("broadwell").moments(line.data(), omega.data());
    RC_ASSERT(called("broadwell").equilibrium(omega.data(), e.data()));
    const std::array<double, 4> expected = {e[0], e[2], e[1], e[1]};
    for (std::size_t k = 0; k < 4; ++k) RC_ASSERT(std::abs(of.e[k] - expected[k]) <= 1e-15 * omega[0]);
  });
}

}  // namespace broadwell_plane_test
