// Kernels and their formulas on single numbers have the same bits in every instruction set, at every point.
#include <apsis/boundary/continuation_rows.hpp>
#include <apsis/boundary/formulas/continuation.hpp>
#include <apsis/core/random_source.hpp>

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>
#include <support/reference_numbers.hpp>

namespace boundary_formulas_test {

namespace {

using apsis::random_source;
namespace scalar = apsis::scalar;

double continued(double a0, double a1, double a2, double ghost) {
  return scalar::continuation<double>(a0, a1, a2).average(ghost);
}

}  // namespace

TEST(formulas, continuations_are_those_of_single_numbers) {
  check_property("continuation", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 40));
    std::array<std::vector<double>, 3> inside;
    for (auto& row : inside) row = drawn(n, random, any_size);
    const auto inward = drawn(n, random, any_sign);
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      std::array<std::vector<double>, 2> ghosts{std::vector<double>(n), std::vector<double>(n)};
      const std::array<double*, 2> rows{ghosts[0].data(), ghosts[1].data()};
      apsis::continuation_rows::fill({inside[0].data(), inside[1].data(), inside[2].data()},
                                     static_cast<int>(n), rows);
      const auto check = [&](const auto& enters) {
        for (std::size_t k = 0; k < n; ++k) {
          scalar::continuation<N> of{N(inside[0][k]), N(inside[1][k]), N(inside[2][k])};
          if (enters(k)) of.curvature = N(0.0);
          for (std::size_t g = 0; g < 2; ++g)
            RC_ASSERT(same_bits(ghosts[g][k], value_of(of.average(N(static_cast<double>(g + 1))))));
        }
      };
      check([](std::size_t) { return false; });
      apsis::continuation_rows::fill_at_border({inside[0].data(), inside[1].data(), inside[2].data()},
                                               inward.data(), static_cast<int>(n), rows);
      check([&](std::size_t k) { return inward[k] > 0.0; });
    });
  });
}

TEST(continuations, of_smooth_averages_are_parabolas_of_any_size) {
  // Averages of 1 + x + x² over cells of width h beside x = 0. The limit of steepness changes the
  // continuation by O(h¹²) only.
  const double h = 0.01;
  const auto average = [h](double k) { return 1.0 + (k + 0.5) * h + (k * k + k + 1.0 / 3.0) * h * h; };
  for (const double size : {1.0, 1e300, 1e-290})
    for (const double ghost : {1.0, 2.0})
      EXPECT_NEAR(continued(size * average(0), size * average(1), size * average(2), ghost) / size,
                  average(-ghost), 1e-15);
}

TEST(continuations, of_jumps_stay_near_the_value_inside) {
  // Of the differences s, d beside the value a = 2e, one vanishes. The kept share is then at most
  // 2e⁴/(s⁴ + e⁴).
  EXPECT_EQ(continued(0.0, 0.0, 0.0, 1.0), 0.0);
  EXPECT_EQ(continued(2.5, 2.5, 2.5, 2.0), 2.5);
  EXPECT_NEAR(continued(1e-3, 1.0, 1.0, 1.0), 1e-3, 1e-9);
  EXPECT_GT(continued(5e-324, 5e-324, 0.0, 1.0), 0.0);
}

}  // namespace boundary_formulas_test
