// Dense output: its order, its bounds, and its values at both ends of a step.
#include <apsis/integrate/evolution.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <integrate/evolution_model.hpp>
#include <support/bad_input.hpp>

namespace evolution_test {

namespace {

/// Returns the largest difference between dense output at several points of every step and a reference.
template <class Reference>
double dense_error(const std::string& name, double epsilon, long steps, const Reference& reference) {
  auto problem = ode_model::as_relaxation<state>(epsilon);
  evolution one(apsis::find_integrator(name), problem, rule::fixed(1.0 / static_cast<double>(steps)));
  one.start(0.0, {2, std::sin(2.0)});
  double largest = 0.0;
  one.advance(1.0, [&](long, double t, double length, const state&) {
    for (const double part : {0.25, 0.5, 0.75}) {
      const double at = t - part * length;
      largest = std::max(largest, difference(one.at(at), reference(at)));
    }
    return true;
  });
  return largest;
}

/// Returns the solution of the model at t, a multiple of 1/1024, for ε = 1. The errors of 2048 steps of order
/// 4 are below 1e-13.
state reference_at(double t) {
  static const std::vector<state> all = [] {
    auto problem = ode_model::as_relaxation<state>(1.0);
    apsis::stepper march(apsis::find_method("kutta-4"), problem);
    std::vector<state> found;
    state u{2, std::sin(2.0)};
    apsis::integrate(march, u, 0.0, 1.0, rule::fixed(1.0 / 2048),
                     [&found](long, double, double, const state& now) { found.push_back(now); });
    return found;
  }();
  return all.at(static_cast<std::size_t>(std::lround(2048 * t)));
}

}  // namespace

TEST(dense_output, has_the_order_of_the_method) {
  for (const auto& [name, order] : {std::pair<std::string, int>{"md-imex-3-2", 2},
                                    {"md-imex-6-3", 3},
                                    {"kutta-4", 4},
                                    {"imex-bdf-3", 3},
                                    {"exponential-2", 2}}) {
    const double coarse = dense_error(name, 1.0, 128, reference_at),
                 fine = dense_error(name, 1.0, 256, reference_at);
    // The order of md-imex-6-3 grows to 3: 2.53, 2.75 and 2.87 with 64, 128 and 256 steps.
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.2) << name;
  }
}

TEST(dense_output, meets_the_solution_at_both_ends_of_a_step) {
  auto problem = ode_model::as_relaxation<state>(0.01);
  for (const std::string name : {"md-imex-6-3", "ssp2-222", "exponential-2"})
    for (const bool tolerated : {false, true}) {
      evolution one(apsis::find_integrator(name), problem, rule::fixed(dt),
                    tolerated ? std::optional(within(1e-4)) : std::nullopt);
      one.start(0.0, {2, 0});
      state before{2, 0};
      one.advance(0.25, [&](long, double t, double length, const state& u) {
        EXPECT_EQ(one.at(t), u);
        EXPECT_EQ(one.at(one.begin_of_step()), before);
        // Dense output at the end repeats the step. It has the same numbers if the difference of times is
        // exactly the length of the step.
        if (t - one.begin_of_step() == length) {
          const state almost = one.at(std::nextafter(t, 0.0));
          EXPECT_LT(difference(almost, u), 1e-13);
        }
        before = u;
        return true;
      });
      EXPECT_EQ(one.t(), 0.25) << name;
    }
}

// A caller can store the beginnings of steps. Dense output is then available in the whole interval, also
// after its end.
TEST(dense_output, is_known_later_from_kept_begins_of_steps) {
  auto problem = ode_model::as_relaxation<state>(0.01);
  for (const char* name : {"md-imex-6-3", "dop853"}) {
    evolution one(apsis::find_integrator(name), problem, rule::unlimited(), within(1e-5));
    one.start(0.0, {2, 0});
    struct place {
      double begin, t;
      state before, inside;
    };
    std::vector<place> kept;
    state before{2, 0};
    one.advance(1.0, [&](long, double t, double length, const state& u) {
      kept.push_back({one.begin_of_step(), t - length / 3, before, one.at(t - length / 3)});
      before = u;
      return true;
    });
    for (const auto& [begin, t, from, inside] : kept)
      EXPECT_EQ(one.step_from(begin, from, t), inside) << name;
    EXPECT_EQ(one.step_from(kept[0].begin, kept[0].before, kept[0].begin), kept[0].before);
    bad_input::expect_refused({{[&] { one.step_from(0.5, {2, 0}, 0.4); },
                                {"the time 0.4 is before the beginning of its step (0.5)"}}});
  }
}

TEST(dense_output, does_not_disturb_the_steps) {
  auto problem = ode_model::as_relaxation<state>(0.01);
  for (const auto& name :
       {"md-imex-6-3", "imex-bdf-4", "imex-dimsim-2", "two-step-8-3-narrow", "exponential-2"}) {
    evolution quiet(apsis::find_integrator(name), problem, rule::fixed(dt)),
        watched(apsis::find_integrator(name), problem, rule::fixed(dt));
    for (evolution* one : {&quiet, &watched}) one->start(0.0, {2, 0});
    quiet.advance(1.0);
    watched.advance(1.0, [&](long, double t, double length, const state&) {
      watched.at(t - length / 3);
      return true;
    });
    EXPECT_EQ(watched.u(), quiet.u()) << name;
  }
}

// Polynomials through the steps would leave [0, 1], but a step does not.
TEST(dense_output, preserves_bounds_as_steps_do) {
  constexpr int cells = 40;
  auto advection = apsis::relaxation_problem(
      [](double, const state& u, state& out) {
        for (std::size_t i = 0; i < u.size(); ++i) out[i] = u[i == 0 ? u.size() - 1 : i - 1] - u[i];
      },
      [](const state& u) { return u; }, [](const state& w, state& e) { e = w; },
      [](const state&) { return 0.0; }, 1.0);
  const auto& m = apsis::find_integrator("ssprk-3-3");
  apsis::evolution one(m, advection, rule::fixed(m.ssp_coefficient));  // Δt_FE = 1
  state box(cells, 0.0);
  std::fill(box.begin() + 5, box.begin() + 15, 1.0);
  one.start(0.0, box);
  one.advance(20.0, [&](long, double t, double length, const state&) {
    for (const double part : {0.1, 0.35, 0.5, 0.9})
      for (const double x : one.at(t - part * length)) {
        EXPECT_GE(x, -1e-15);
        EXPECT_LE(x, 1.0 + 1e-15);
      }
    return true;
  });
}

TEST(dense_output, is_refused_outside_the_last_step) {
  auto problem = ode_model::as_relaxation<state>(0.3);
  evolution one(apsis::find_integrator("md-imex-6-3"), problem, rule::fixed(0.25));
  one.start(0.0, {2, 0});
  EXPECT_EQ(one.at(0.0), one.u());
  one.advance(0.5);
  bad_input::expect_refused({
      {[&] { one.at(0.2); }, {"the time 0.2 is not in the last step (from 0.25 to 0.5)"}},
      {[&] { one.at(0.6); }, {"is not in the last step"}},
      {[&] { one.at(std::nan("")); }, {"is not in the last step"}},
  });
}

}  // namespace evolution_test
