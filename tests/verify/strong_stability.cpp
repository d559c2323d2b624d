// The largest step that preserves a property: the promise Δt ≤ r Δt_FE and its sharpness.
#include <apsis/verify/strong_stability.hpp>

#include <apsis/integrate/newton_problem.hpp>
#include <apsis/verify/adversaries.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace apsis::strong_stability_test {
namespace {

using row = std::vector<double>;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns the methods for T with the r that they promise.
std::vector<std::pair<std::string, double>> promising_methods() {
  std::vector<std::pair<std::string, double>> all;
  for (const auto& name : method_names()) {
    const certificate& c = find_certificate(name);
    if (c.kind != method_kind::implicit_only && promised_coefficient(c) > 0.0)
      all.emplace_back(name, promised_coefficient(c));
  }
  return all;
}

/// The bisection is accurate to 1e-4 of the step. The promise must hold to that accuracy.
constexpr double bisection = 2e-4;

step_limit words(const std::string& name, double epsilon, double lowest = 0.0625) {
  constexpr int memory = 2;
  const int letters = static_cast<int>(find_method(name).stages());
  auto problem = word_problem(letters, memory, epsilon);
  const std::vector<row> data{word_data(letters, memory)};
  return largest_step(find_method(name), problem, std::span<const row>(data),
                      stays_inside<row>("positivity", negative_part(1), 1e-13),
                      {.stages = true, .lowest = lowest});
}

TEST(strong_stability, the_promise_is_sharp_for_operators_that_change_from_stage_to_stage) {
  // With moderate collisions contributions of different stages still mix. They separate as ε → 0.
  for (const auto& [name, r] : promising_methods()) {
    const auto kind = find_method(name).kind;
    double sharpest = infinity;
    for (const double epsilon : {infinity, 1.0, 1e-2, 1e-4}) {
      if (kind == method_kind::explicit_only && epsilon < infinity) continue;
      const auto limit = words(name, epsilon);
      EXPECT_GE(limit.kept, r * (1 - bisection)) << name << " " << epsilon;
      // For epsilon = 0.01 an exact collision of time 1/3 reduces a negative number by e^{−33}.
      if (kind == method_kind::exact_collision && epsilon < 0.1) continue;
      EXPECT_GT(limit.excess, 0.0) << name << " " << epsilon;
      sharpest = std::min(sharpest, limit.lost);
    }
    EXPECT_NEAR(sharpest, r, 1e-3 * r) << name;
  }
}

TEST(strong_stability,
     imex_methods_without_a_coefficient_lose_positivity_at_a_thousandth_of_the_step_for_some_epsilon) {
  for (const auto& name : method_names()) {
    const certificate& c = find_certificate(name);
    if (c.kind != method_kind::imex || promised_coefficient(c) > 0.0) continue;
    double least = infinity;
    for (const double epsilon : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6})
      least = std::min(least, words(name, epsilon, 1e-3).kept);
    EXPECT_EQ(least, 0.0) << name;  // lost on the first rung, Δt_FE/1000
  }
}

TEST(strong_stability, implicit_methods_on_square_decay_preserve_what_their_certificate_promises) {
  // For G = −10 u² and u ≤ 10, u + τG ≥ 0 if τ ≤ 1/100.
  newton_problem problem(no_transport{}, [](const auto& u, auto& out) { out[0] = -10 * u[0] * u[0]; });
  const std::vector<row> data{{10.0}, {1.0}, {1e-3}};
  const auto positive = stays_inside<row>("positivity", negative_part());
  for (const auto& name : method_names()) {
    const certificate& c = find_certificate(name);
    if (c.kind != method_kind::implicit_only) continue;
    const step_search how{.steps = 5, .stages = true, .highest = 1e10, .rung = 2.0, .unit = 0.01};
    const auto limit = largest_step(find_method(name), problem, std::span<const row>(data), positive, how);
    EXPECT_GE(limit.kept, std::min(promised_coefficient(c), 0.5e10) * (1 - bisection)) << name;
    EXPECT_EQ(std::isinf(limit.lost), c.unconditional) << name;
    if (name == "dirk-2-2") {
      EXPECT_NEAR(limit.kept, 2.0, 1e-3);
    }
  }
  // dirk-2-2 has the classical radius 2, which is sharp here (C11). dirk-4-3 has the radius 0, but this
  // problem is not its worst case.
  EXPECT_EQ(promised_coefficient(find_certificate("dirk-2-2")), 2.0);
  EXPECT_EQ(promised_coefficient(find_certificate("dirk-4-3")), 0.0);
}

TEST(strong_stability, the_forward_euler_step_of_upwind_advection_is_sharp) {
  ring_advection ring;
  const auto rows = adversarial_rows(24, 5);
  const auto tv = does_not_grow<row>("total variation", total_variation);
  EXPECT_NEAR(largest_forward_euler_step(ring, std::span<const row>(rows), tv).kept, 1.0, bisection);
}

TEST(strong_stability, a_wrong_promise_is_detected) {
  // Δt_FE is too large by 1 %.
  struct boastful : ring_advection {
    double forward_euler_step(double, const state&) const { return 1.01; }
  } problem;
  const auto rows = adversarial_rows(24, 0);
  const auto tv = does_not_grow<row>("total variation", total_variation);
  EXPECT_LT(largest_step(find_method("ssprk-3-3"), problem, std::span<const row>(rows), tv).kept, 0.995);
  EXPECT_LT(largest_forward_euler_step(problem, std::span<const row>(rows), tv).kept, 0.995);
  // Forward Euler does not preserve this concave functional for any step.
  const auto curvature = does_not_grow<row>("not convex", [](const row& u) { return -total_variation(u); });
  EXPECT_EQ(largest_step(find_method("ssprk-3-3"), problem, std::span<const row>(rows), curvature).kept, 0.0);
}

TEST(strong_stability, searches_test_the_promised_step_itself) {
  const auto up_to_one = [](std::size_t, double dt) { return dt <= 1.0 ? 0.0 : 1.0; };
  EXPECT_EQ(search_step(1, 1.0, {.accuracy = 0.1, .promised = 1.0}, up_to_one).kept, 1.0);
  // A wrong promise only changes the beginning of the search.
  const auto refuted = search_step(1, 1.0, {.promised = 1.02}, up_to_one);
  EXPECT_NEAR(refuted.kept, 1.0, 1e-4);
  EXPECT_GT(refuted.lost, 1.0);
}

TEST(strong_stability, searches_climb_before_they_bisect) {
  // The property holds up to 0.3 and again from 0.5 on. The first loss counts.
  const auto limit = search_step(
      3, 2.0, {}, [](std::size_t k, double dt) { return k == 1 && dt > 0.6 && dt < 1.0 ? 7.0 : -1.0; });
  EXPECT_NEAR(limit.kept, 0.3, 1e-4);
  EXPECT_NEAR(limit.lost, 0.3, 1e-4);
  EXPECT_EQ(limit.data, 1U);
  EXPECT_EQ(limit.excess, 7.0);
  EXPECT_THROW(search_step(0, 1.0, {}, [](std::size_t, double) { return 0.0; }), input_error);
  EXPECT_THROW(search_step(1, infinity, {}, [](std::size_t, double) { return 0.0; }), input_error);
  EXPECT_EQ(search_step(1, 1.0, {}, [](std::size_t, double) { return std::nan(""); }).kept, 0.0);
}

}  // namespace
}  // namespace apsis::strong_stability_test
