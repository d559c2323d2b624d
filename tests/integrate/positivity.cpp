// The implicit methods of the paper on u' = −10u² and beyond: C10–C13.
#include <apsis/core/errors.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/random.hpp>
#include <support/property.hpp>

namespace {

using apsis::find_method;
using apsis::integrate;
using apsis::no_transport;
using apsis::step_rule;
using apsis::stepper;
using random_input::integer;
using random_input::magnitude;
using random_input::one_in;
using random_input::uniform;
using row = std::vector<double>;

const std::vector<std::string> ssp_methods{"imdrk-1-2", "imdrk-2-3", "imdrk-5-4"};

constexpr auto square_decay = [](const auto& u, auto& out) { out[0] = -10 * u[0] * u[0]; };

/// The problem with every stage looked at as it is solved.
struct observed_decay : apsis::newton_problem<no_transport, decltype(square_decay)> {
  observed_decay() : newton_problem(no_transport{}, square_decay) {}
  void collide(double t, double a, double b, row& u) {
    newton_problem::collide(t, a, b, u);
    lowest_stage = std::min(lowest_stage, u[0]);
  }
  double lowest_stage = std::numeric_limits<double>::infinity();
};

/// What happens to u(0) = 10 in `steps` steps.
struct outcome {
  bool solvable = true;    ///< every stage equation has a root
  bool positive = true;    ///< every stage and every step is > 0
  bool decreasing = true;  ///< u^{n+1} < u^n
  double last = 10;
};

outcome decay(const std::string& method, double dt, int steps) {
  observed_decay problem;
  stepper march(find_method(method), problem);
  outcome result;
  row u{10};
  try {
    for (int n = 0; n < steps; ++n) {
      march.step(n * dt, dt, u);
      result.decreasing = result.decreasing && u[0] < result.last;
      result.positive = result.positive && u[0] > 0;
      result.last = u[0];
    }
  } catch (const apsis::numerical_error&) {
    result.solvable = false;
  }
  result.positive = result.positive && problem.lowest_stage > 0;
  return result;
}

TEST(claims, C10_implicit_methods_keep_square_decay_positive_for_every_step) {
  for (const auto& method : ssp_methods) {
    for (int n = 4; n <= 64; n *= 2) {
      const auto result = decay(method, 1.0 / n, 2 * n);
      EXPECT_TRUE(result.solvable && result.positive && result.decreasing) << method << " 1/" << n;
    }
    for (double dt = 1; dt <= 1e8; dt *= 10) {
      const auto result = decay(method, dt, 20);
      EXPECT_TRUE(result.solvable && result.positive && result.decreasing) << method << " " << dt;
    }
  }
}

/// The functional must not grow by more than `rounding`, relatively.
void expect_no_growth(const std::function<double(const row&)>& functional, const auto& g,
                      const std::string& method, double dt, double rounding, row u) {
  apsis::newton_problem problem(no_transport{}, g);
  stepper march(find_method(method), problem);
  double before = functional(u);
  for (int n = 0; n < 3; ++n) {
    march.step(0, dt, u);
    const double after = functional(u);
    RC_ASSERT(after <= before * (1 + rounding));
    before = after;
  }
}

std::string any_ssp_method() {
  return ssp_methods[static_cast<std::size_t>(integer(0, static_cast<int>(ssp_methods.size())))];
}

TEST(claims, C10_beyond_random_powers_decay_without_sign_change_for_every_step) {
  check_property("G = −c u^p", [] {
    const int p = integer(1, 6);
    const double c = magnitude(-4, 4), dt = magnitude(-8, 8);
    const auto g = [=](const auto& u, auto& out) {
      out[0] = -c * u[0];
      for (int k = 1; k < p; ++k) out[0] *= u[0];
    };
    apsis::newton_problem problem(no_transport{}, g);
    stepper march(find_method(any_ssp_method()), problem);
    row u{magnitude(-3, 3)};
    for (int n = 0; n < 5; ++n) {
      const double before = u[0];
      march.step(0, dt, u);
      // A decay below the rounding of u is lost in it: the convex combination of stages is good to an ulp or
      // two.
      RC_ASSERT(u[0] >= 0 && u[0] <= before * (1 + 1e-15));
      if (p > 1) RC_ASSERT(u[0] > 0);  // linear decay soon underflows
    }
  });
}

TEST(claims, C10_beyond_random_dissipative_fields_keep_the_euclidean_norm_for_every_step) {
  // G(u) = S g(Sᵀu), g_i(w) = −c_i w − e_i w³, S an orthogonal reflection: forward Euler with a small step
  // and u − τ²Ġ, Ġ_i = (c_i + e_i w²)(c_i + 3 e_i w²) w_i, both shorten every w_i, hence the norm.
  check_property("reflected cubic decay", [] {
    const std::size_t n = static_cast<std::size_t>(integer(1, 5));
    row c(n), e(n), u(n), normal(n);
    double square = 0, fastest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      c[i] = one_in(3) ? 0.0 : magnitude(-3, 3);
      e[i] = one_in(3) ? 0.0 : magnitude(-3, 3);
      u[i] = uniform(-5, 5);
      fastest = std::max(fastest, c[i] + 3 * e[i] * 100);  // |w| ≤ ‖u‖ ≤ 10
      normal[i] = uniform(0.1, 1);
      square += normal[i] * normal[i];
    }
    const auto at = [&](std::size_t i, std::size_t k) {
      return (i == k ? 1.0 : 0.0) - 2 * normal[i] * normal[k] / square;
    };
    const auto g = [&](const auto& v, auto& out) {
      for (std::size_t i = 0; i < n; ++i) out[i] = 0 * v[i];
      for (std::size_t k = 0; k < n; ++k) {
        auto w = 0 * v[0];
        for (std::size_t i = 0; i < n; ++i) w += at(i, k) * v[i];
        const auto slope = -w * (c[k] + e[k] * w * w);
        for (std::size_t i = 0; i < n; ++i) out[i] += at(i, k) * slope;
      }
    };
    const auto norm = [](const row& v) {
      double sum = 0;
      for (const double x : v) sum += x * x;
      return std::sqrt(sum);
    };
    // k = Δt · fastest rate. Rounding enters Ġ times k² and comes back undamped in directions where G
    // vanishes.
    const double k = magnitude(-4, 3), dt = k / std::max(fastest, 1e-3);
    expect_no_growth(norm, g, any_ssp_method(), dt, 1e-14 * (1 + k * k), u);
  });
}

TEST(claims, C10_beyond_random_convex_functionals_decrease_under_averaging_for_every_step) {
  // G(u) = C (mean(u) − u) with C depending on the mean: Ġ = −C G. Forward Euler and u − τ²Ġ are averages of
  // permutations of u, so every convex functional that is symmetric decreases, not only norms.
  check_property("symmetric convex functionals", [] {
    const std::size_t n = static_cast<std::size_t>(integer(2, 7)), pieces = 4;
    row u(n), slope(pieces), offset(pieces);
    for (double& x : u) x = uniform(-3, 3);
    for (std::size_t k = 0; k < pieces; ++k) {
      slope[k] = uniform(-2, 2);
      offset[k] = uniform(-1, 1);
    }
    const double rate = magnitude(-3, 1), dt = magnitude(-4, 2);
    const auto g = [=](const auto& v, auto& out) {
      auto mean = 0 * v[0];
      for (std::size_t i = 0; i < n; ++i) mean += v[i] / static_cast<double>(n);
      for (std::size_t i = 0; i < n; ++i) out[i] = rate * (1 + mean * mean) * (mean - v[i]);
    };
    // Σ_i h(u_i) with h the maximum of random affine functions, shifted so that rounding is relative to it.
    const auto functional = [=](const row& v) {
      double sum = 0;
      for (const double x : v) {
        double h = -1e300;
        for (std::size_t k = 0; k < pieces; ++k) h = std::max(h, slope[k] * x + offset[k]);
        sum += h + 10;
      }
      return sum;
    };
    // The rounding of mean(u) shifts all components alike and enters Ġ times (Δt C)², C ≤ 10 rate: a general
    // G does not conserve the mean better than that (relaxation_problem does).
    const double rounding = 1e-14 * (1 + std::pow(10 * rate * dt, 2));
    expect_no_growth(functional, g, any_ssp_method(), dt, rounding, u);
  });
}

/// The largest step (by bisection) for which 20 steps keep every stage positive.
double positivity_limit(const std::string& method) {
  double keeps = 1e-3, loses = 0.1;
  for (int n = 0; n < 60; ++n) {
    const double dt = (keeps + loses) / 2;
    const auto result = decay(method, dt, 20);
    (result.solvable && result.positive ? keeps : loses) = dt;
  }
  return keeps;
}

TEST(claims, C11_dirk_methods_lose_positivity_beyond_1_50_and_1_75) {
  // A stage passes through zero there, and its sign is decided by rounding: 1e-12 is generous.
  EXPECT_NEAR(positivity_limit("dirk-2-2"), 1.0 / 50, 1e-12);
  EXPECT_NEAR(positivity_limit("dirk-4-3"), 1.0 / 75, 1e-12);
}

TEST(claims, C12_monotone_decay_holds_for_the_ssp_methods_and_fails_for_dirk) {
  const double exact = 1 / 20.1;  // u(2) = 1/(1/10 + 20)
  for (int n = 4; n <= 64; n *= 2) {
    for (const std::string method : {"imdrk-1-2", "imdrk-2-3"}) {
      const auto result = decay(method, 1.0 / n, 2 * n);
      EXPECT_TRUE(result.solvable && result.positive && result.decreasing) << method << " 1/" << n;
      EXPECT_NEAR(result.last, exact, 0.3 * exact) << method << " 1/" << n;
    }
    const auto dirk2 = decay("dirk-2-2", 1.0 / n, 2 * n), dirk3 = decay("dirk-4-3", 1.0 / n, 2 * n);
    // 1/64 < 1/50: of the steps in the figure only the smallest is harmless, and only for the second order.
    EXPECT_EQ(dirk2.solvable && dirk2.positive && dirk2.decreasing, n == 64) << n;
    EXPECT_FALSE(dirk3.solvable && dirk3.positive && dirk3.decreasing) << n;
  }
}

TEST(claims, C13_implicit_methods_reach_orders_2_3_and_4_on_square_decay) {
  const auto error = [](const std::string& method, long steps) {
    auto problem = apsis::make_newton_problem<std::vector<long double>>(no_transport{}, square_decay);
    stepper march(find_method(method), problem);
    std::vector<long double> u{10};
    integrate(march, u, 0.0L, 2.0L, step_rule<long double>::fixed(2.0L / static_cast<long double>(steps)));
    return std::abs(u[0] - 1 / 20.1L);
  };
  // At Δt = 2/16384 the observed orders are within 0.07 of the design order and still approach it.
  for (std::size_t k = 0; k < ssp_methods.size(); ++k) {
    const double order =
        static_cast<double>(std::log2(error(ssp_methods[k], 8192) / error(ssp_methods[k], 16384)));
    EXPECT_NEAR(order, 2.0 + static_cast<double>(k), 0.1) << ssp_methods[k];
  }
}

}  // namespace
