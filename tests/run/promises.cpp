#include "cases.hpp"

#include <apsis/core/errors.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace promises_test {

namespace {
const std::string both[] = {"finite-volume", "finite-difference"};
}  // namespace

TEST(promises, no_negative_value_at_safety_one_for_any_epsilon) {
  for (const auto& how : both) {
    for (const char* method : {"md-imex-3-2", "md-imex-6-3"}) {
      for (const char* epsilon : {"0", "1e-12", "1e-6", "1e-2", "1", "1e4", "1e12", "x < 1 ? 0 : 1e12"}) {
        auto c = small(method, how);
        c.time.cfl.reset();
        c.time.safety = 1.0;
        c.model.epsilon = epsilon;
        apsis::simulation run(c);
        ASSERT_TRUE(run.promises().positivity);
        finish(run);
        EXPECT_EQ(run.summary().negative_values, 0) << method << " " << epsilon;
        EXPECT_LE(run.summary().conservation_defect, 1e-12) << method << " " << epsilon;
      }
    }
  }
}

TEST(promises, beyond_the_limit_nothing_is_promised_and_values_become_negative) {
  // With first-order upwind and almost no collisions, a forward Euler step of 2 Δt_FE gives the cell a
  // negative weight. An exception of any kind fails the test. The run ends before a temperature is negative.
  auto c = small("md-imex-3-2", "finite-difference");
  c.space.reconstruction = "upwind1";
  c.space.limiter = apsis::limiter_choice::none;
  c.model.epsilon = "1e12";
  c.time.cfl.reset();
  c.time.safety = 2.5;
  c.time.end = 2.0;
  apsis::simulation run(c);
  EXPECT_FALSE(run.promises().positivity);
  while (!run.finished() && run.last().negative_values == 0) run.advance();
  EXPECT_GT(run.last().negative_values, 0);
  EXPECT_LT(run.last().min_value, 0.0);

  // Within the limit the same case stays nonnegative up to the same time.
  c.time.safety = 1.0;
  c.time.end = run.t();
  apsis::simulation within(c);
  EXPECT_TRUE(within.promises().positivity);
  finish(within);
  EXPECT_EQ(within.summary().negative_values, 0);
}

TEST(promises, entropy_decays_with_first_order_upwind_for_any_epsilon) {
  for (const char* method : {"md-imex-3-2", "md-imex-6-3"}) {
    for (const char* epsilon : {"0", "1e-12", "1e-4", "1", "1e12"}) {
      auto c = small(method, "finite-volume");
      c.space.reconstruction = "upwind1";
      c.time.cfl.reset();
      c.time.safety = 1.0;
      c.time.end = 0.3;
      c.model.epsilon = epsilon;
      apsis::simulation run(c);
      ASSERT_TRUE(run.promises().entropy);
      const double start = run.initial_record().entropy;
      finish(run);
      EXPECT_LE(run.summary().max_entropy_increase, 1e-14 * std::abs(start)) << method << " " << epsilon;
      EXPECT_LT(run.last().entropy, start) << "the test is vacuous without decay";
    }
  }
}

TEST(promises, follow_from_the_configuration) {
  auto c = small("md-imex-3-2", "finite-volume");
  EXPECT_TRUE(apsis::simulation(c).promises().positivity);
  EXPECT_FALSE(apsis::simulation(c).promises().entropy);
  c.space.limiter = apsis::limiter_choice::none;
  EXPECT_FALSE(apsis::simulation(c).promises().positivity);
  EXPECT_TRUE(apsis::simulation(c).promises().conservation);
  c.space.limiter = apsis::limiter_choice::positivity;
  c.time.cfl = 0.2;  // 2.4 times the limit 1/12
  EXPECT_FALSE(apsis::simulation(c).promises().positivity);
}

TEST(promises, explicit_collisions_beyond_their_step_do_not_promise_conservation_to_rounding) {
  // Explicit evaluations of Q/ε have rounding errors. Δt/ε amplifies them in the invariants.
  const auto promises = [](const std::string& method) {
    return apsis::simulation(apsis::load_case("benchmarks/entropy-violation", {"time.method=" + method}))
        .promises();
  };
  EXPECT_FALSE(promises("imex-trapezoidal").conservation);
  EXPECT_TRUE(promises("md-imex-3-2").conservation);
  EXPECT_TRUE(promises("md-imex-3-2").entropy);
}

TEST(promises, transverse_momentum_is_conserved_although_it_is_zero) {
  for (const int dimensions : {2, 3})
    for (const auto& how : both) {
      auto c = small("md-imex-6-3", how);
      c.model.parameters["velocity_dimensions"] = dimensions;
      c.velocity = {8.0, 14, apsis::equilibrium_choice::discrete};
      c.time.end = 0.01;
      EXPECT_LE(finished(c).conservation_defect, 1e-12) << dimensions;
    }
}

TEST(promises, a_broken_promise_ends_the_run_with_step_and_value) {
  auto c = small("md-imex-3-2", "finite-difference");
  apsis::simulation run(c);
  run.advance();
  auto saved = run.save();
  for (double& value : saved.unknowns) value *= 1.0 + 1e-9;  // a spurious source of mass
  run.restore(saved);
  try {
    finish(run);
    FAIL() << "the defect was not detected";
  } catch (const apsis::numerical_error& failure) {
    EXPECT_NE(failure.problem().find("broken promise: mass is not conserved"), std::string::npos)
        << failure.what();
    EXPECT_EQ(failure.site().step, 2);
    EXPECT_GT(failure.site().value, 1e-12);
  }
}

TEST(promises, a_formula_with_inexact_moments_disables_the_promise_of_conservation_with_a_note) {
  // Δv is close to √T, and v_max = 9 is only a few thermal speeds.
  auto c = small("md-imex-3-2", "finite-difference");
  c.velocity = {9.0, 22, apsis::equilibrium_choice::formula};
  c.model.epsilon = "1e-3";
  testing::internal::CaptureStderr();
  apsis::simulation run(c);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("the moments of the equilibrium miss those of the initial data by 4e-10"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("use velocity.equilibrium = \"auto\""), std::string::npos) << said;
  EXPECT_FALSE(run.promises().conservation);
  EXPECT_TRUE(run.promises().positivity);
  finish(run);
  EXPECT_GT(run.summary().conservation_defect, 1e-11)
      << "conservation holds to rounding although it was not promised";
  auto upwind = c;
  upwind.space.reconstruction = "upwind1";
  EXPECT_FALSE(apsis::simulation(upwind).promises().entropy);

  // The discrete Maxwellian conserves on the same grid, and the formula conserves on the grid of the paper.
  c.velocity.equilibrium = apsis::equilibrium_choice::discrete;
  EXPECT_TRUE(apsis::simulation(c).promises().conservation);
  EXPECT_LE(finished(c).conservation_defect, 1e-12);
  c.velocity = {15.0, 150, apsis::equilibrium_choice::formula};
  testing::internal::CaptureStderr();
  EXPECT_TRUE(apsis::simulation(c).promises().conservation);
  EXPECT_EQ(testing::internal::GetCapturedStderr().find("warning"), std::string::npos);
  EXPECT_LE(finished(c).conservation_defect, 1e-12);
}

TEST(simulation, continues_a_saved_run_bit_for_bit) {
  auto c = small("md-imex-6-3", "finite-volume");
  apsis::simulation whole(c), first(c), second(c);
  finish(whole);
  for (int k = 0; k < 17; ++k) first.advance();
  second.restore(first.save());
  EXPECT_EQ(second.step(), 17);
  finish(second);
  EXPECT_EQ(whole.state(), second.state());
  EXPECT_EQ(whole.t(), second.t());
  EXPECT_EQ(whole.last().entropy_change, second.last().entropy_change);
  EXPECT_EQ(whole.summary().min_value, second.summary().min_value);
  auto other = c;
  other.space.cells = {21};
  apsis::simulation different(other);
  try {
    different.restore(first.save());
    FAIL() << "accepted";
  } catch (const apsis::input_error& refused) {
    EXPECT_EQ(std::string(refused.what()).find("the saved state has another size than the case"), 0u)
        << refused.what();
  }
}

TEST(simulation, an_interval_of_length_zero_returns_the_initial_state) {
  auto c = small("md-imex-3-2", "finite-volume");
  c.time.end = 0.0;
  apsis::simulation run(c);
  EXPECT_TRUE(run.finished());
  EXPECT_EQ(run.summary().steps, 0);
  EXPECT_EQ(run.fields().x.size(), 20u);
}

TEST(simulation, refuses_invalid_configurations_before_the_first_step) {
  const auto base = small("md-imex-3-2", "finite-volume");
  const auto refused = [&base](const auto& change) {
    auto c = base;
    change(c);
    EXPECT_THROW(apsis::simulation{c}, apsis::input_error);
  };
  EXPECT_NO_THROW(apsis::simulation{base});
  refused([](auto& c) { c.velocity.max = 3.0; });
  refused([](auto& c) { c.velocity.points = 6; });
  refused([](auto& c) { c.space.cells = {4}; });
  refused([](auto& c) { c.time.method = "imdrk-2-3"; });
  refused([](auto& c) { c.model.epsilon = "x - 1"; });
  refused([](auto& c) {
    c.time.cfl.reset();
    c.time.dt = 1e-300;
  });
}

TEST(simulation, without_space_is_an_ordinary_differential_equation) {
  apsis::case_config c;
  c.model.name = "decay";
  c.model.parameters = {{"rate", 10.0}, {"u0", 10.0}};
  c.time.method = "imdrk-5-4";
  c.time.end = 2.0;
  const auto error = [&c](int steps) {
    c.time.dt = 2.0 / steps;
    apsis::simulation run(c);
    finish(run);
    return std::abs(run.state()[0] - 1.0 / (0.1 + 20.0));
  };
  EXPECT_NEAR(std::log2(error(4096) / error(8192)), 4.0, 0.15);
  c.time.dt.reset();
  c.time.safety = 1.0;
  bad_input::expect_refused({
      {[&] { apsis::simulation{c}; }, {"nothing limits the time step"}},
  });
}

TEST(simulation, free_flight_is_fifth_order_with_and_without_limiter) {
  // Almost free flight on meshes of 40, 80 and 160 cells, whose differences give the order. The time step is
  // proportional to Δx^{5/3}, so that third order in time does not mask fifth order in space.
  for (const auto& how : both) {
    for (const auto limiter : {apsis::limiter_choice::none, apsis::limiter_choice::positivity}) {
      const auto solution = [&](int n) {
        auto c = small("ssprk-3-3", how);
        c.model.initial = "accuracy";
        c.model.epsilon = "1e12";
        c.space.cells = {n};
        c.space.limiter = limiter;
        c.velocity.points = 24;
        c.time.cfl = 0.2 * std::pow(40.0 / n, 2.0 / 3.0);
        c.time.end = 0.1;
        apsis::simulation run(c);
        finish(run);
        return run.fields();
      };
      const auto coarse = solution(40), middle = solution(80), fine = solution(160);
      const auto difference = [&](const apsis::field_table& a, const apsis::field_table& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.x.size(); ++i) {
          // Coarse averages are means of two fine ones. Point values are interpolated between fine centres at
          // sixth order.
          const auto& f = b.values[0];
          const std::size_t n = f.size();
          const double pair = how == "finite-volume" ? 0.5 * (f[2 * i] + f[2 * i + 1])
                                                     : (150.0 * (f[2 * i] + f[2 * i + 1]) -
                                                        25.0 * (f[(2 * i + n - 1) % n] + f[(2 * i + 2) % n]) +
                                                        3.0 * (f[(2 * i + n - 2) % n] + f[(2 * i + 3) % n])) /
                                                           256.0;
          sum += std::abs(a.values[0][i] - pair);
        }
        return sum / static_cast<double>(a.x.size());
      };
      EXPECT_GT(std::log2(difference(coarse, middle) / difference(middle, fine)), 4.7)
          << how << choice_name(limiter);
    }
  }
}

}  // namespace promises_test
