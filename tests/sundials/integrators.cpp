// Integrations over N_Vectors: the numbers of the library, orders, limits, bounds, and settings.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sundials/line.hpp>
#include <sundials/support.hpp>

namespace sundials_integrators_test {

namespace {

using namespace sundials_test;
using line_test::line;

line of_cells(std::ptrdiff_t cells, double epsilon, double diffusion = 0.0) {
  return {.cells = cells, .begin = 0, .end = cells, .diffusion = diffusion, .epsilon = epsilon};
}

vector start_of(const line& of) {
  auto made = serial(std::vector<double>(2 * of.own()));
  line_test::start(of, made.get());
  return made;
}

/// Returns an integrator of a line with products of the Jacobian and a preconditioner.
integrator make_line(const std::string& method, line& of) {
  auto s = make(method, line_test::transport, line_test::collision, 0.0, start_of(of).get(), &of);
  expect_ok(apsis_sundials_set_products(s.get(), nullptr, line_test::product));
  expect_ok(
      apsis_sundials_set_preconditioner(s.get(), line_test::precondition_setup, line_test::precondition));
  return s;
}

/// Returns the state at t after `steps` equal steps.
std::vector<double> after_steps(const std::string& method, line of, double t, int steps) {
  auto s = make_line(method, of);
  expect_ok(apsis_sundials_set_step(s.get(), t / steps));
  const auto y = start_of(of);
  expect_ok(apsis_sundials_evolve(s.get(), t, y.get(), nullptr));
  EXPECT_EQ(apsis_sundials_count(s.get(), APSIS_SUNDIALS_STEPS), steps);
  return values(y.get());
}

double distance(const std::vector<double>& x, const std::vector<double>& y) {
  double largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i] - y[i]));
  return largest;
}

/// u' = −(u² − w)/ε, w' = −u'. This is the line without space, with the callbacks of apsis.h.
struct exchange {
  double epsilon;
};

int rate(size_t, size_t, const double* u, double* q, void* data) {
  q[0] = -(u[0] * u[0] - u[1]) / static_cast<const exchange*>(data)->epsilon;
  q[1] = -q[0];
  return 0;
}

int jacobian(size_t, size_t, const double* u, double* j, void* data) {
  const double to_u = 2.0 * u[0] / static_cast<const exchange*>(data)->epsilon;
  const double to_w = -1.0 / static_cast<const exchange*>(data)->epsilon;
  const double all[] = {-to_u, -to_w, to_u, to_w};
  std::copy(all, all + 4, j);
  return 0;
}

}  // namespace

TEST(sundials_integrators, have_the_numbers_of_the_library) {
  for (const std::string name :
       {"md-imex-6-3", "md-imex-8-3-mixed", "ark-436", "ssp3-433", "imdrk-9-5-accurate"})
    for (const double epsilon : {1.0, 1e-3, 1e-8}) {
      exchange data{epsilon};
      apsis_integrator* reference = nullptr;
      expect_ok(apsis_new_integrator(find(name).get(), 2, &reference));
      apsis_set_data(reference, &data);
      apsis_set_rate(reference, rate);
      apsis_set_jacobian(reference, jacobian);
      apsis_set_step(reference, 0.05);
      const double u0[] = {1.1, 0.9};
      expect_ok(apsis_start(reference, 0.0, u0));
      expect_ok(apsis_integrate(reference, 1.0));

      line of = of_cells(1, epsilon);
      auto s = make(name, nullptr, line_test::collision, 0.0, serial({1.1, 0.9}).get(), &of);
      expect_ok(apsis_sundials_set_products(s.get(), nullptr, line_test::product));
      expect_ok(
          apsis_sundials_set_preconditioner(s.get(), line_test::precondition_setup, line_test::precondition));
      expect_ok(apsis_sundials_set_step(s.get(), 0.05));
      const auto y = serial({0, 0});
      expect_ok(apsis_sundials_evolve(s.get(), 1.0, y.get(), nullptr));
      for (std::size_t i = 0; i < 2; ++i)
        // Both find roots up to rounding. ark-436 also evaluates Q, whose rounding errors have
        // the size 2^−53/ε.
        EXPECT_NEAR(values(y.get())[i], apsis_state(reference)[i],
                    2e-14 + (name == "ark-436" ? 1e-17 / epsilon : 0))
            << name << " " << epsilon;
      apsis_free_integrator(reference);
    }
}

TEST(sundials_integrators, have_the_order_of_the_method) {
  const std::pair<const char*, int> orders[] = {{"md-imex-3-2", 2},
                                                {"md-imex-6-3", 3},
                                                {"md-imex-8-3-mixed", 3},
                                                {"ark-436", 4},
                                                {"md-imex-16-4-efficient", 4}};
  const line of = of_cells(12, 0.5, 0.01);
  const auto truth = after_steps("md-imex-16-4-efficient", of, 0.5, 400);
  for (const auto& [name, order] : orders) {
    const double coarse = distance(after_steps(name, of, 0.5, 40), truth);
    const double fine = distance(after_steps(name, of, 0.5, 80), truth);
    EXPECT_GT(std::log2(coarse / fine), order - 0.25) << name << " " << coarse << " " << fine;
  }
}

TEST(sundials_integrators, keep_their_order_for_collisions_of_any_speed) {
  // The data approach equilibrium after a short time. The limit is then a diffusion of u + w with w = u².
  for (const double epsilon : {1e-4, 1e-7, 1e-10}) {
    const line of = of_cells(12, epsilon, 0.01);
    const auto truth = after_steps("md-imex-3-2", of, 0.5, 640);
    const double coarse = distance(after_steps("md-imex-3-2", of, 0.5, 20), truth);
    const double fine = distance(after_steps("md-imex-3-2", of, 0.5, 40), truth);
    EXPECT_LT(coarse, 5e-3) << epsilon;
    EXPECT_GT(std::log2(coarse / fine), 1.6) << epsilon << " " << coarse << " " << fine;
    for (std::size_t i = 0; i < truth.size(); i += 2)
      EXPECT_NEAR(truth[i + 1], truth[i] * truth[i], 10 * epsilon) << epsilon;
  }
}

TEST(sundials_integrators, solve_stages_of_steps_much_longer_than_relaxation_or_end_with_an_error) {
  for (const std::string name :
       {"md-imex-3-2", "md-imex-8-3-mixed", "md-imex-16-4-efficient", "imdrk-9-5-accurate"})
    for (const double epsilon : {1e-6, 1e-8, 1e-10, 1e-12, 1e-14}) {
      line of = of_cells(24, epsilon, 0.01);
      auto s = name.starts_with("imdrk")
                   ? make(name, nullptr, line_test::collision, 0.0, start_of(of).get(), &of)
                   : make_line(name, of);
      expect_ok(apsis_sundials_set_products(s.get(), nullptr, line_test::product));
      expect_ok(
          apsis_sundials_set_preconditioner(s.get(), line_test::precondition_setup, line_test::precondition));
      expect_ok(apsis_sundials_set_step(s.get(), 1.0 / 128));
      const auto y = start_of(of);
      const int status = apsis_sundials_evolve(s.get(), 1.0 / 16, y.get(), nullptr);
      // In all successful runs a step is up to 8e7 relaxation times long.
      if (epsilon >= 1e-10) {
        EXPECT_EQ(status, APSIS_OK) << name << " " << epsilon << " " << apsis_error_message();
      }
      if (status != APSIS_OK) {
        EXPECT_EQ(status, APSIS_NUMERICAL_ERROR);
        continue;
      }
      // Diffusion keeps the solution off the equilibrium by about ε/100.
      for (std::size_t i = 0; i < values(y.get()).size(); i += 2)
        EXPECT_NEAR(values(y.get())[i + 1], std::pow(values(y.get())[i], 2), epsilon + 1e-14)
            << name << " " << epsilon;
    }
}

TEST(sundials_integrators, conserve_linear_invariants) {
  for (const double epsilon : {1.0, 1e-6}) {
    line of = of_cells(16, epsilon, 0.02);
    auto s = make_line("md-imex-6-3", of);
    expect_ok(apsis_sundials_set_tolerance(s.get(), 1e-5, 1e-8));
    const auto y = start_of(of);
    const auto before = values(y.get());
    expect_ok(apsis_sundials_evolve(s.get(), 1.0, y.get(), nullptr));
    const auto after = values(y.get());
    // Up to rounding, corrections are linear combinations of vectors with the sum 0.
    EXPECT_NEAR(std::accumulate(after.begin(), after.end(), 0.0),
                std::accumulate(before.begin(), before.end(), 0.0), 1e-11);
  }
}

/// The stage equation has another root near u = −1/2, where the derivative of the exchange vanishes. Newton's
/// method finds it from u = 0.
TEST(sundials_integrators, reach_the_equilibrium_that_short_steps_reach) {
  for (const bool tolerant : {false, true})
    for (const double epsilon : {1e-2, 1e-3, 3e-4, 1e-6}) {
      line of = of_cells(1, epsilon);
      of.speed = 0.0;
      const auto s = make_line("md-imex-8-3-mixed", of);
      const auto y = serial({0.0, 1.0});
      expect_ok(apsis_sundials_reset(s.get(), 0.0, y.get()));
      expect_ok(tolerant ? apsis_sundials_set_tolerance(s.get(), 1e-8, 1e-10)
                         : apsis_sundials_set_step(s.get(), 0.125));
      expect_ok(apsis_sundials_evolve(s.get(), 10.0, y.get(), nullptr));
      // u² = 1 − u. Equal steps solve stages to rounding, others to 1e-3 of the tolerance.
      EXPECT_NEAR(values(y.get())[0], (std::sqrt(5.0) - 1.0) / 2.0, tolerant ? 1e-7 : 1e-10) << epsilon;
    }
}

TEST(sundials_integrators, reach_a_tolerance_with_every_way_to_solve) {
  const line of = of_cells(8, 1e-3, 0.02);
  const auto truth = after_steps("md-imex-6-3", of, 0.4, 800);
  for (const std::string name : {"md-imex-6-3", "ark-436"})
    for (const bool products : {true, false})
      for (const bool preconditioned : {true, false}) {
        line data = of;
        auto s = make(name, line_test::transport, line_test::collision, 0.0, start_of(of).get(), &data);
        if (products) expect_ok(apsis_sundials_set_products(s.get(), nullptr, line_test::product));
        if (preconditioned)
          expect_ok(apsis_sundials_set_preconditioner(s.get(), line_test::precondition_setup,
                                                      line_test::precondition));
        expect_ok(apsis_sundials_set_tolerance(s.get(), 1e-6, 1e-8));
        const auto y = start_of(of);
        expect_ok(apsis_sundials_evolve(s.get(), 0.4, y.get(), nullptr));
        EXPECT_LT(distance(values(y.get()), truth), 3e-5) << name << products << preconditioned;
        EXPECT_EQ(apsis_sundials_count(s.get(), APSIS_SUNDIALS_PRODUCTS) > 0, products);
        EXPECT_EQ(data.preconditioned_gammas > 0, preconditioned);
      }
}

TEST(sundials_integrators, keep_positive_states_up_to_the_promised_step_and_not_beyond) {
  const auto smallest_after = [](double factor) {
    line of = of_cells(40, 1e-2);
    of.linear = true;
    const auto y = start_of(of);
    for (std::size_t i = 0; i < 2 * of.own(); ++i)
      line_test::numbers(y.get())[i] = i == 20 || i == 21 ? 1.0 : 0.0;
    auto s = make("md-imex-5-2", line_test::transport, line_test::collision, 0.0, y.get(), &of);
    expect_ok(apsis_sundials_set_products(s.get(), nullptr, line_test::product));
    expect_ok(apsis_sundials_set_forward_euler_step(s.get(), line_test::forward_euler_step));
    expect_ok(apsis_sundials_set_safety(s.get(), factor));
    double smallest = 0.0;
    for (int k = 1; k <= 5; ++k) {
      expect_ok(apsis_sundials_evolve(s.get(), 0.05 * k * factor, y.get(), nullptr));
      smallest = std::min(smallest, N_VMin(y.get()));
    }
    return smallest;
  };
  // Roots are exact up to rounding, also those of size 0.
  EXPECT_GE(smallest_after(1.0), -1e-15);
  EXPECT_LT(smallest_after(1.6), -1e-4);
}

TEST(sundials_integrators, satisfy_constraints_or_stop) {
  line of = of_cells(40, 1e-2);
  of.linear = true;
  const auto y = start_of(of), positive = serial(std::vector<double>(80, 1.0));
  for (std::size_t i = 0; i < 80; ++i) line_test::numbers(y.get())[i] = i == 20 || i == 21 ? 1.0 : 0.0;
  auto s = make("md-imex-6-3", line_test::transport, line_test::collision, 0.0, y.get(), &of);
  expect_ok(apsis_sundials_set_products(s.get(), nullptr, line_test::product));
  expect_ok(apsis_sundials_set_constraints(s.get(), positive.get()));
  expect_ok(apsis_sundials_set_step(s.get(), 0.2));
  EXPECT_EQ(apsis_sundials_evolve(s.get(), 1.0, y.get(), nullptr), APSIS_NUMERICAL_ERROR);
  EXPECT_NE(std::string(apsis_error_message()).find("constraints"), std::string::npos)
      << apsis_error_message();
  expect_ok(apsis_sundials_set_step(s.get(), 0.0));
  expect_ok(apsis_sundials_set_tolerance(s.get(), 1e-2, 1e-2));
  expect_ok(apsis_sundials_evolve(s.get(), 0.5, y.get(), nullptr));
  EXPECT_GE(N_VMin(y.get()), 0.0);
}

}  // namespace sundials_integrators_test
