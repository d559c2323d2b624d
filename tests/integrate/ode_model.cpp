// The ODE model of the paper: C19 (orders, reduction, plateaus), C20 (self-convergence), C21 (round-off).
#include <apsis/integrate/integrate.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <integrate/reference.hpp>

namespace {

template <class Real>
std::vector<Real> solve(const std::string& method, Real epsilon, long steps) {
  using state = std::vector<Real>;
  auto problem = ode_model::as_relaxation<state>(epsilon);
  apsis::stepper march(apsis::find_method(method), problem);
  state u = ode_model::initial_state<state>();
  apsis::integrate(march, u, Real(0), Real(1),
                   apsis::step_rule<Real>::fixed(Real(1) / static_cast<Real>(steps)));
  return u;
}

template <class Row, class Other>
double distance(const Row& u, const Other& v) {
  return static_cast<double>(std::abs(u[0] - v[0]) + std::abs(u[1] - v[1]));
}

/// Errors for steps, 2 steps, 4 steps, …
std::vector<double> errors(const std::string& method, double epsilon, long steps, int levels) {
  const auto exact = reference::radau(epsilon, 1);
  std::vector<double> all;
  for (int k = 0; k < levels; ++k, steps *= 2) all.push_back(distance(solve(method, epsilon, steps), exact));
  return all;
}

/// Slope of log error over log Δt by least squares.
double slope(const std::vector<double>& values) {
  double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  const double n = static_cast<double>(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double x = -static_cast<double>(k), y = std::log2(values[k]);
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

TEST(claims, C19_second_order_method_has_order_2_at_epsilon_1_and_1e_10) {
  EXPECT_NEAR(slope(errors("md-imex-3-2", 1.0, 128, 7)), 2, 0.1);
  EXPECT_NEAR(slope(errors("md-imex-3-2", 1e-10, 16, 9)), 2, 0.1);
}

TEST(claims, C19_third_order_method_has_order_3_at_epsilon_1_and_1e_10) {
  EXPECT_NEAR(slope(errors("md-imex-6-3", 1.0, 64, 7)), 3, 0.1);
  // Below Δt = 1/256 the error 3e-12 · 1e3 of Δt³ meets the plateau at 0.3 ε.
  EXPECT_NEAR(slope(errors("md-imex-6-3", 1e-10, 8, 6)), 3, 0.1);
}

TEST(claims, C19_order_is_reduced_between) {
  for (const std::string method : {"md-imex-3-2", "md-imex-6-3"})
    for (const double epsilon : {1e-3, 1e-4}) {
      // From Δt = 1/64 to 1/1024, where Δt and ε are comparable, less than first order is seen.
      EXPECT_LT(slope(errors(method, epsilon, 64, 5)), 1) << method << " " << epsilon;
    }
}

TEST(claims, C19_plateaus_are_proportional_to_epsilon) {
  for (const std::string method : {"md-imex-3-2", "md-imex-6-3"}) {
    // On the plateau: ε ≪ Δt, and Δt^p is far below ε.
    const auto plateau = [&](double epsilon, long steps) {
      return errors(method, epsilon, steps, 1)[0] / epsilon;
    };
    const double coarse = plateau(1e-4, 512), middle = plateau(1e-5, 2048), fine = plateau(1e-6, 8192);
    EXPECT_GT(std::min({coarse, middle, fine}), 0.02) << method;
    EXPECT_LT(std::max({coarse, middle, fine}), 0.5) << method;
    EXPECT_NEAR(middle / fine, 1, 0.3) << method;
  }
}

TEST(claims, C20_on_the_plateau_the_methods_still_converge_at_design_order) {
  const auto self_convergence = [](const std::string& method, double epsilon, long steps, int levels) {
    std::vector<double> all;
    auto u = solve(method, epsilon, steps);
    for (int k = 0; k < levels; ++k) {
      steps *= 2;
      const auto v = solve(method, epsilon, steps);
      all.push_back(distance(u, v));
      u = v;
    }
    return slope(all);
  };
  // The true error of md-imex-6-3 at ε = 1e-6 is flat at 3.4e-7 from Δt = 1/64 on, that of md-imex-3-2 from
  // 1/2048.
  EXPECT_LT(slope(errors("md-imex-6-3", 1e-6, 64, 3)), 0.1);
  EXPECT_NEAR(self_convergence("md-imex-6-3", 1e-6, 16, 4), 3, 0.15);
  EXPECT_LT(slope(errors("md-imex-3-2", 1e-6, 2048, 3)), 0.5);
  EXPECT_NEAR(self_convergence("md-imex-3-2", 1e-6, 64, 6), 2, 0.1);
}

/// The third-order method as one would type it from the paper: 15 printed digits in double, whose rows sum to
/// 1 only to rounding, and the closed form of the stage.
std::array<double, 2> solve_as_printed(double epsilon, long steps) {
  constexpr double r = 0.904402174130635;
  constexpr std::array<double, 6> initial{1, 0.688151680893388, 0, 0.583517183806433, 0, 0};
  constexpr std::array<double, 6> d{0, 2, 0.388820513661584, 0.083529464436389, 1.793313488277995, 0};
  constexpr std::array<double, 6> d_dot{0.871358934880525, 0.856842702601821, 0, 0, 2, 0.205134529930013};
  using matrix = std::array<std::array<double, 6>, 6>;
  constexpr matrix w{{{},
                      {0.058453072749259},
                      {0.764266518291495},
                      {0, 0, 0.292520982667463},
                      {0.173788618990251, 0, 0, 0.281050180194829},
                      {0.016811671845949, 0, 0, 0.448630511341543}}};
  constexpr matrix p{{{},
                      {0.253395246357353},
                      {0, 0.235733481708505},
                      {0, 0.123961833526104},
                      {0.409037644509411, 0.136123556305509},
                      {0.203353399602184, 0, 0, 0, 0.331204417210324}}};
  const double dt = 1 / static_cast<double>(steps);
  std::array<double, 2> u{2, 0};
  for (long n = 0; n < steps; ++n) {
    std::array<std::array<double, 2>, 6> stage{};
    for (std::size_t i = 0; i < 6; ++i) {
      double first = initial[i] * u[0], second = initial[i] * u[1];
      for (std::size_t j = 0; j < i; ++j) {
        first += p[i][j] * stage[j][0] + w[i][j] * (stage[j][0] + dt / r * stage[j][1]);
        second += (p[i][j] + w[i][j]) * stage[j][1];
      }
      const double k = dt * (1 + first * first) / epsilon, mu = d[i] * k + d_dot[i] * k * k;
      stage[i] = {first, (second + mu * std::sin(first)) / (1 + mu)};
    }
    u = stage[5];
  }
  return u;
}

TEST(claims, C21_round_off_stops_third_order_below_5e_5_as_printed) {
  const auto exact = reference::radau(1, 1);
  const double before = distance(solve_as_printed(1, 5000), exact);
  const double turn = distance(solve_as_printed(1, 20000), exact);
  const double after = distance(solve_as_printed(1, 80000), exact);
  const double far = distance(solve_as_printed(1, 320000), exact);
  EXPECT_LT(turn, before / 4);
  // The rows' missing 1e-16 are lost again at every step: the error grows in proportion to their number.
  EXPECT_GT(after, 1.5 * turn);
  EXPECT_NEAR(far / after, 4, 1);
}

TEST(claims, C21_rows_that_sum_to_one_and_long_double_remove_it) {
  const auto exact = reference::radau(1, 1);
  const auto error = [&]<class Real>(Real epsilon, long steps) {
    return distance(solve("md-imex-6-3", epsilon, steps), exact);
  };
  // The catalogue's coefficients sum to 1 without rounding, so that no step drifts: a tenth of the printed
  // ones' error is left in double, from roundings that do not add up.
  EXPECT_LT(error(1.0, 320000), 0.1 * distance(solve_as_printed(1, 320000), exact));
  EXPECT_LT(error(1.0, 320000), error(1.0, 20000));
  // In long double the error goes on falling with the third power, over Δt = 5e-5 to 1e-14.
  const double first = error(1.0L, 20000), second = error(1.0L, 40000), third = error(1.0L, 80000);
  EXPECT_NEAR(std::log2(first / second), 3, 0.1);
  EXPECT_NEAR(std::log2(second / third), 3, 0.1);
}

}  // namespace
